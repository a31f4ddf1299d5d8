#include "harness/command_line/help.hpp"

#include <cstddef>
#include <vector>

#include "harness/support/errors.hpp"
#include "harness/support/nearest.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

constexpr std::size_t column_of_text = 30;

using Options = std::vector<const CLI::Option*>;

/// What stands on the left, and what is told of it on the right, or below if the left is too long.
std::string entry(const std::string& left, const std::string& right) {
    std::string line = "  " + left;
    std::string above;
    if (line.size() + 2 > column_of_text) {
        above = line + '\n';
        line.clear();
    }
    line.resize(column_of_text, ' ');
    return above + wrapped(line + right, column_of_text);
}

std::string with_default(const std::string& name, const CLI::Option& option) {
    const std::string value = option.get_default_str();
    return name + (value.empty() ? "" : "=" + value);
}

std::string told_of(const CLI::Option& option) {
    std::string text = option.get_description();
    for (const CLI::Option* other : option.get_needs()) {
        text += "; needs " + other->get_name();
    }
    return text;
}

Options positional(const CLI::App& app) {
    return app.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

std::string under(const std::string& heading, const std::vector<HelpEntry>& entries) {
    std::string text = entries.empty() ? "" : "\n" + heading + ":\n";
    for (const auto& [left, right] : entries) {
        text += entry(left, right);
    }
    return text;
}

/// The verbs of a group, with their whole help or a line each.
std::string group_text(const CLI::App& app, const std::string& name, const std::string& group, bool whole) {
    std::string text;
    std::vector<HelpEntry> lines;
    for (const CLI::App* verb : verbs_of(app, group)) {
        text += whole ? "\n" + verb->help(name) : "";
        lines.push_back({verb->get_name(), verb->get_description()});
    }
    return whole ? text : under(group, lines);
}

std::string verbs_text(const CLI::App& app, const std::string& name, bool whole) {
    std::string text;
    for (const char* group : {groups::measure, groups::simulate, groups::study, groups::machine}) {
        text += group_text(app, name, group, whole);
    }
    return whole ? text + group_text(app, name, groups::none, whole) : text;
}

} // namespace

std::vector<HelpEntry> arguments_of(const CLI::App& verb) {
    std::vector<HelpEntry> entries;
    for (const CLI::Option* option : positional(verb)) {
        entries.push_back({with_default(option->get_name(true), *option), told_of(*option)});
    }
    return entries;
}

std::vector<HelpEntry> options_of(const CLI::App& verb) {
    std::vector<HelpEntry> entries;
    for (const CLI::Option* option : verb.get_options([](const auto* one) { return one->nonpositional(); })) {
        const bool takes_a_value = option->get_items_expected_max() > 0;
        const std::string names = option->get_name(false, true);
        const std::string typed = takes_a_value ? names + " " + option->get_type_name() : names;
        entries.push_back({takes_a_value ? with_default(typed, *option) : typed, told_of(*option)});
    }
    return entries;
}

std::string usage_of(const CLI::App& app, const std::string& name) {
    std::string line = name + " [OPTIONS]";
    for (const CLI::Option* option : positional(app)) {
        const std::string many = option->get_items_expected_max() > 1 ? "..." : "";
        const std::string shown = option->get_name(true) + many;
        line += option->get_required() ? " " + shown : " [" + shown + "]";
    }
    const bool has_verbs = !app.get_subcommands([](const CLI::App*) { return true; }).empty();
    return line + (has_verbs ? " VERB" : "");
}

std::vector<const CLI::App*> verbs_of(const CLI::App& program, const std::string& group) {
    return program.get_subcommands([&](const CLI::App* verb) { return verb->get_group() == group; });
}

std::string Help::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
    std::string text = wrapped(app->get_description(), 0) + wrapped("Usage: " + usage_of(*app, name), 2) +
                       under("Arguments", arguments_of(*app)) + under("Options", options_of(*app)) +
                       verbs_text(*app, name, mode == CLI::AppFormatMode::All);
    const std::string footer = app->get_footer();
    return text + (footer.empty() ? "" : "\n" + wrapped(footer, 2));
}

CLI::App& require_verb(CLI::App& program, const std::string& name) {
    std::vector<std::string> names;
    for (CLI::App* verb : program.get_subcommands([](CLI::App*) { return true; })) {
        if (verb->get_name() == name) {
            return *verb;
        }
        names.push_back(verb->get_name());
    }
    throw InputError("found " + in_quotes(name) + ", expected a verb out of `carom --help`" +
                     did_you_mean(name, names));
}

} // namespace carom
