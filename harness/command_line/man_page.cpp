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

std::string entry(const HelpEntry& one) {
    return ".TP\n.B " + escaped(one.left) + "\n" + escaped(one.right) + "\n";
}

std::string verb_section(const CLI::App& verb) {
    std::string text = ".SS carom " + escaped(verb.get_name()) + "\n" + escaped(verb.get_description()) +
                       ".\n.PP\n" + escaped(usage_of(verb, "carom " + verb.get_name())) + "\n";
    for (const HelpEntry& one : arguments_of(verb)) {
        text += entry(one);
    }
    for (const HelpEntry& one : options_of(verb)) {
        text += entry(one);
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
        for (const CLI::App* verb : verbs_of(program, group)) {
            text += entry({verb->get_name(), verb->get_description()});
            details += verb_section(*verb);
        }
    }
    return text + details + ".SH EXIT STATUS\n" + escaped(program.get_footer()) + "\n";
}

} // namespace carom
