#include "harness/command_line/help.hpp"

#include <cstddef>
#include <sstream>
#include <utility>
#include <vector>

#include "harness/support/errors.hpp"
#include "harness/support/nearest.hpp"
#include "harness/support/text.hpp"

namespace carom {

Help::Help() {
    label("Positionals", "Arguments");
    label("SUBCOMMAND", "VERB");
}

std::string Help::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
    std::istringstream lines(CLI::Formatter::make_help(app, std::move(name), mode));
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t indent = line.starts_with("  ") ? get_column_width() : 2;
        text += wrapped(line, text.empty() ? 0 : indent);
    }
    while (text.ends_with("\n\n")) {
        text.pop_back();
    }
    return text;
}

std::string Help::make_subcommands(const CLI::App* app, CLI::AppFormatMode mode) const {
    if (mode != CLI::AppFormatMode::All) {
        return CLI::Formatter::make_subcommands(app, mode);
    }
    std::string text;
    for (const CLI::App* verb : app->get_subcommands([](const CLI::App*) { return true; })) {
        text += "\n" + verb->help(app->get_name());
    }
    return text;
}

/// What is told stands on the right, or below if what is typed is too long.
std::string Help::make_option(const CLI::Option* option, bool is_argument) const {
    std::string line = "  " + option->get_name(is_argument, !is_argument);
    if (option->get_items_expected_max() > 0) {
        const std::string value = option->get_default_str();
        line += (is_argument ? "" : " " + option->get_type_name()) + (value.empty() ? "" : "=" + value);
    }
    const bool fits = line.size() + 2 <= get_column_width();
    line += fits ? "" : "\n";
    line.append(get_column_width() - (fits ? line.size() : 0), ' ');
    line += option->get_description();
    for (const CLI::Option* other : option->get_needs()) {
        line += "; needs " + other->get_name();
    }
    return line + "\n";
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
