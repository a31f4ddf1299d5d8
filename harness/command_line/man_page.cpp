#include "harness/command_line/man_page.hpp"

#include <string_view>

#include "harness/command_line/help.hpp"

namespace carom {
namespace {

/// A text as roff takes it: nothing in it is a request.
std::string escaped(std::string_view text) {
    std::string roff;
    for (const char letter : text) {
        if (letter == '\\') {
            roff += "\\e";
        } else if (letter == '-') {
            roff += "\\-";
        } else {
            if ((letter == '.' || letter == '\'') && (roff.empty() || roff.back() == '\n')) {
                roff += "\\&";
            }
            roff += letter;
        }
    }
    return roff;
}

std::string entry(const std::string& typed, const std::string& told) {
    return ".TP\n.B " + escaped(typed) + "\n" + escaped(told) + "\n";
}

std::string verb_section(const CLI::App& verb) {
    const std::string name = "carom " + verb.get_name();
    std::string text = ".SS " + escaped(name) + "\n" + escaped(verb.get_description()) + ".\n.PP\n" +
                       escaped(Help().make_usage(&verb, name));
    for (const CLI::Option* argument :
         verb.get_options([](const auto* one) { return one->get_positional(); })) {
        text += entry(typed_form(*argument, true), told_of(*argument));
    }
    for (const CLI::Option* option : verb.get_options([](const auto* one) { return one->nonpositional(); })) {
        text += entry(typed_form(*option, false), told_of(*option));
    }
    return text;
}

} // namespace

std::string man_page(const CLI::App& program, const std::string& version) {
    std::string text = ".TH CAROM 1 \"\" \"carom " + escaped(version) + "\"\n.SH NAME\ncarom \\- " +
                       escaped(program.get_description()) +
                       "\n.SH SYNOPSIS\n.B carom\nVERB [OPTIONS]\n.SH VERBS\n";
    std::string details = ".SH EACH VERB\n";
    for (const char* group : {groups::measure, groups::simulate, groups::study, groups::machine}) {
        text += ".SS " + escaped(group) + "\n";
        const auto is_in_group = [&](const CLI::App* verb) { return verb->get_group() == group; };
        for (const CLI::App* verb : program.get_subcommands(is_in_group)) {
            text += entry(verb->get_name(), verb->get_description());
            details += verb_section(*verb);
        }
    }
    return text + details + ".SH EXIT STATUS\n" + escaped(program.get_footer()) + "\n";
}

} // namespace carom
