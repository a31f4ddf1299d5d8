#include "harness/command_line/usage_errors.hpp"

#include <algorithm>
#include <cstddef>

#include "harness/support/nearest.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

using Found = std::optional<std::string>;

/// "`carom run --help`".
std::string help_of(const CLI::App& app) {
    const CLI::App* parent = app.get_parent();
    return "`" + (parent == nullptr ? "" : parent->get_name() + " ") + app.get_name() + " --help`";
}

Found unexpected_argument(const CLI::App& app) {
    const auto words = app.remaining();
    if (words.empty()) {
        return std::nullopt;
    }
    const auto arguments =
        app.get_options([](const CLI::Option* option) { return option->get_positional(); });
    const auto name = [](const CLI::Option* argument) { return argument->get_name(true); };
    return "found " + in_quotes(words.front()) + ", expected no argument" +
           (arguments.empty() ? "" : " after " + CLI::detail::join(arguments, name, " ")) + ": " +
           help_of(app);
}

Found missing_argument(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_required() && option->count() == 0) {
            const bool argument = option->get_positional();
            return "found no " + option->get_name(argument) + ", expected it: " + help_of(app);
        }
    }
    return std::nullopt;
}

/// An option that needs another one, or that cannot stand beside it.
Found wrong_pair(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
        if (option->count() == 0) {
            continue;
        }
        for (const CLI::Option* other : option->get_needs()) {
            if (other->count() == 0) {
                return "found " + option->get_name() + " without " + other->get_name() + ", expected both";
            }
        }
        for (const CLI::Option* other : option->get_excludes()) {
            if (other->count() != 0) {
                return "found " + option->get_name() + " with " + other->get_name() +
                       ", expected one of them";
            }
        }
    }
    return std::nullopt;
}

Found given_twice(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
        const auto most = static_cast<std::size_t>(std::max(option->get_items_expected_max(), 0));
        const auto& values = option->results();
        if (most > 0 && values.size() > most) {
            return option->get_name() + ": found " + in_quotes(values[0]) + " and " + in_quotes(values[1]) +
                   ", expected it once";
        }
    }
    return std::nullopt;
}

/// The option that CLI11's text is about, without a value behind it.
Found without_value(const CLI::App& app, const std::string& text) {
    for (const CLI::Option* option :
         app.get_options([](const CLI::Option* one) { return one->nonpositional(); })) {
        if (option->get_items_expected_max() > 0 && text.starts_with(option->get_name() + ":")) {
            return option->get_name() + ": found nothing after it, expected " + option->get_type_name();
        }
    }
    return std::nullopt;
}

std::string first_line_of(const std::string& text) {
    constexpr std::size_t longest = 200;
    return text.substr(0, std::min(text.find('\n'), longest));
}

Found wrong(const CLI::App& app, const CLI::ParseError& error) {
    switch (static_cast<CLI::ExitCodes>(error.get_exit_code())) {
    case CLI::ExitCodes::ExtrasError:
        return unexpected_argument(app);
    case CLI::ExitCodes::RequiredError:
        return missing_argument(app);
    case CLI::ExitCodes::RequiresError:
    case CLI::ExitCodes::ExcludesError:
        return wrong_pair(app);
    case CLI::ExitCodes::ArgumentMismatch: {
        const Found twice = given_twice(app);
        return twice ? twice : without_value(app, error.what());
    }
    default:
        return std::nullopt;
    }
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
        if (const Found unknown = unknown_option(*one, one->remaining())) {
            return *unknown;
        }
    }
    const bool lacks_something = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError);
    if (called.empty() && program.get_require_subcommand_min() > 0 && lacks_something) {
        return "found no verb, expected one out of " + help_of(program);
    }
    return wrong(app, error).value_or(first_line_of(error.what()));
}

} // namespace carom
