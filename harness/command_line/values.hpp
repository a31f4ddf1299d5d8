#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/support/output_file.hpp"
#include "harness/support/text.hpp"

// What options take, and what is said of what they do not, whichever release of CLI11 reads the command line:
// "--threads: found 'two', expected a whole number from 1 to 1024". CLI11's own validators word it otherwise.

namespace carom {

/// A number that is `right`, or else a message with what was `expected`. It is handed on in plain decimal
/// digits, since CLI11 would read 010 as an octal number.
template <class Number, class Right> CLI::Validator number_that(Right right, const std::string& expected) {
    const auto check = [right, expected](std::string& text) {
        const std::optional<Number> value = parse_number<Number>(text);
        if (!value || !right(*value)) {
            return "found " + in_quotes(text) + ", expected " + expected;
        }
        text = number_text(*value);
        return std::string();
    };
    return {check, ""};
}

/// A number of that type within the bounds.
template <class Number> CLI::Validator number_from(Number least, Number most) {
    return number_that<Number>([=](Number value) { return least <= value && value <= most; },
                               (std::is_integral_v<Number> ? "a whole number from " : "a number from ") +
                                   number_text(least) + " to " + number_text(most));
}

inline CLI::Validator finite_number() {
    return number_that<double>([](double value) { return std::isfinite(value); }, "a number");
}

inline CLI::Validator positive_number() {
    return number_that<double>([](double value) { return value > 0 && std::isfinite(value); },
                               "a number above 0");
}

/// One of these words, of which there is one at least.
inline CLI::Validator one_of(const std::vector<std::string>& words) {
    std::string expected = words.front();
    for (std::size_t k = 1; k < words.size(); ++k) {
        expected += (k + 1 < words.size() ? ", " : " or ") + words[k];
    }
    const auto check = [words, expected](std::string& word) {
        return std::ranges::count(words, word) > 0 ? std::string()
                                                   : "found " + in_quotes(word) + ", expected " + expected;
    };
    return {check, ""};
}

/// A file that can be written. Throws InputError: it is told before the work whose result is to go there.
inline CLI::Validator writable() {
    const auto check = [](const std::string& path) {
        require_writable(path);
        return std::string();
    };
    return {check, ""};
}

/// Lets an option take one of these words alone, and shows them in its help: "relative|published".
inline CLI::Option* take_one_of(CLI::Option* option, const std::vector<std::string>& words) {
    return option->check(one_of(words))->type_name(CLI::detail::join(words, "|"));
}

/// Adds an option for a number within bounds, whose default is what `value` holds.
template <class Number>
CLI::Option* add_number(CLI::App& command, const std::string& name, Number& value,
                        std::type_identity_t<Number> least, std::type_identity_t<Number> most,
                        const std::string& help) {
    return command.add_option(name, value, help)
        ->transform(number_from(least, most))
        ->type_name("N")
        ->default_str(number_text(value));
}

/// Adds an option for one of several words, each of which stands for a value; its default is what `value`
/// holds.
template <class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Value& value,
                        const std::vector<std::pair<std::string, Value>>& choices, const std::string& help) {
    std::vector<std::string> words;
    for (const auto& choice : choices) {
        words.push_back(choice.first);
    }
    const auto choose = [&value, choices](const std::string& word) {
        value = std::ranges::find(choices, word, &std::pair<std::string, Value>::first)->second;
    };
    const auto now = std::ranges::find(choices, value, &std::pair<std::string, Value>::second);
    return take_one_of(command.add_option_function<std::string>(name, choose, help), words)
        ->default_str(now->first);
}

} // namespace carom
