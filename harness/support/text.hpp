#pragma once

#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace carom {

/// The whole of `text` as a number, whatever the locale; empty if any of it is no part of one or it is out of
/// range.
template <class Number> std::optional<Number> parse_number(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) {
        return std::nullopt;
    }
    return value;
}

/// Appends the shortest text that reads back as the same number.
template <class Number> void append_number(std::string& text, Number value) {
    std::array<char, 32> digits;
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), end);
}

template <class Number> std::string number_text(Number value) {
    std::string text;
    append_number(text, value);
    return text;
}

} // namespace carom
