#include "harness/command_line/help.hpp"

#include <cstddef>
#include <vector>

#include "harness/support/errors.hpp"
#include "harness/support/nearest.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

constexpr std::size_t columns = 80;
constexpr std::size_t column_of_text = 30;

using Options = std::vector<const CLI::Option*>;

/// Breaks one line at its spaces; what follows a break is indented by so many columns.
std::string wrapped(std::string line, std::size_t indent) {
    std::string text;
    while (line.size() > columns) {
        std::size_t end = line.rfind(' ', columns);
        if (end == std::string::npos || end <= indent) {
            end = line.find(' ', columns);
        }
        if (end == std::string::npos) {
            break;
        }
        text += line.substr(0, end) + '\n';
        line = std::string(indent, ' ') + line.substr(end + 1);
    }
    return text + line + '\n';
}

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

std::string arguments_text(const Options& arguments) {
    std::string text = arguments.empty() ? "" : "\nArguments:\n";
    for (const CLI::Option* option : arguments) {
        text += entry(with_default(option->get_name(true), *option), told_of(*option));
    }
    return text;
}

std::string options_text(const Options& options) {
    std::string text = options.empty() ? "" : "\nOptions:\n";
    for (const CLI::Option* option : options) {
        const bool takes_a_value = option->get_items_expected_max() > 0;
        const std::string type = takes_a_value ? " " + option->get_type_name() : "";
        const std::string names = option->get_name(false, true);
        text += entry(takes_a_value ? with_default(names + type, *option) : names, told_of(*option));
    }
    return text;
}

/// "Usage: carom run [OPTIONS] SCENE [THREADS]".
std::string usage(const CLI::App& app, const std::string& name, const Options& arguments) {
    std::string line = "Usage: " + name + " [OPTIONS]";
    for (const CLI::Option* option : arguments) {
        const std::string many = option->get_items_expected_max() > 1 ? "..." : "";
        const std::string shown = option->get_name(true) + many;
        line += option->get_required() ? " " + shown : " [" + shown + "]";
    }
    const bool has_verbs = !app.get_subcommands([](const CLI::App*) { return true; }).empty();
    return wrapped(line + (has_verbs ? " VERB" : ""), 2);
}

std::string verbs_text(const CLI::App& app, const std::string& name, bool whole) {
    std::string text;
    for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
        text += whole ? "\n" + verb->help(name) : entry(verb->get_name(), verb->get_description());
    }
    return text.empty() || whole ? text : "\nVerbs:\n" + text;
}

} // namespace

std::string Help::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
    const auto arguments =
        app->get_options([](const CLI::Option* option) { return option->get_positional(); });
    const auto options = app->get_options([](const CLI::Option* option) { return option->nonpositional(); });
    std::string text = wrapped(app->get_description(), 0) + usage(*app, name, arguments) +
                       arguments_text(arguments) + options_text(options) +
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
