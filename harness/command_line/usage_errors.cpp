#include "harness/command_line/usage_errors.hpp"

#include <algorithm>
#include <cstddef>

#include "harness/support/nearest.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

/// "`carom run --help`".
std::string help_of(const CLI::App& app) {
    const CLI::App* parent = app.get_parent();
    return "`" + (parent == nullptr ? "" : parent->get_name() + " ") + app.get_name() + " --help`";
}

} // namespace

std::optional<std::string> unknown_option(const CLI::App& verb, const std::vector<std::string>& words) {
    for (const std::string& word : words) {
        if (!word.starts_with('-') || word == "-" || word == "--" || word.starts_with("--benchmark_")) {
            continue;
        }
        const std::string name = word.substr(0, word.find('='));
        std::vector<std::string> names;
        for (const CLI::Option* option : verb.get_options()) {
            for (const std::string& one : option->get_lnames()) {
                names.push_back("--" + one);
            }
        }
        return "found " + in_quotes(name) + ", expected an option of " + help_of(verb) +
               did_you_mean(name, names);
    }
    return std::nullopt;
}

std::string usage_message(const CLI::App& program, const CLI::ParseError& error) {
    const auto called = program.get_subcommands();
    const CLI::App& app = called.empty() ? program : *called.front();
    // A value after an option that is none may stand where an argument is expected, and be refused there.
    for (const CLI::App* one : {&app, &program}) {
        if (const auto unknown = unknown_option(*one, one->remaining())) {
            return *unknown;
        }
    }
    const bool lacks_something = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    if (called.empty() && program.get_require_subcommand_min() > 0 && lacks_something) {
        return "found no verb, expected one out of " + help_of(program);
    }
    constexpr std::size_t longest = 200;
    const std::string told = error.what();
    const std::string line = told.substr(0, std::min(told.find('\n'), longest));
    const bool is_of_a_validator = dynamic_cast<const CLI::ValidationError*>(&error) != nullptr;
    return is_of_a_validator ? line : line + ": " + help_of(app);
}

} // namespace carom
