#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/support/text.hpp"

// What options take, and what is said of what they do not, whichever release of CLI11 reads the command line:
// "--threads: found 'two', expected a whole number from 1 to 1024".

namespace carom {

/// A number of that type within the bounds. It is handed on in plain decimal digits, since CLI11 would read
/// 010 as an octal number.
template <class Number> CLI::Validator number_from(Number least, Number most) {
    const auto check = [least, most](std::string& text) {
        const std::optional<Number> value = parse_number<Number>(text);
        if (!value || !(least <= *value && *value <= most)) {
            return "found " + in_quotes(text) + ", expected a " +
                   (std::is_integral_v<Number> ? "whole " : "") + "number from " + number_text(least) +
                   " to " + number_text(most);
        }
        text = number_text(*value);
        return std::string();
    };
    return {check, ""};
}

/// Any number that is finite.
inline CLI::Validator finite_number() {
    const auto check = [](std::string& text) {
        const std::optional<double> value = parse_number<double>(text);
        const bool finite = value && std::abs(*value) <= std::numeric_limits<double>::max();
        return finite ? std::string() : "found " + in_quotes(text) + ", expected a number";
    };
    return {check, ""};
}

/// "relative|published".
std::string alternatives(const std::vector<std::string>& words);

/// One of these words.
CLI::Validator one_of(const std::vector<std::string>& words);

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
    std::string now;
    for (const auto& choice : choices) {
        words.push_back(choice.first);
        if (choice.second == value) {
            now = choice.first;
        }
    }
    const auto choose = [&value, choices](const std::string& word) {
        value = std::ranges::find(choices, word, &std::pair<std::string, Value>::first)->second;
    };
    return command.add_option_function<std::string>(name, choose, help)
        ->check(one_of(words))
        ->type_name(alternatives(words))
        ->default_str(now);
}

} // namespace carom
