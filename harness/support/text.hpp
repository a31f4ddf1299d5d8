#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

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

/// Takes the next word off a line, up to a blank; empty at the end of the line.
inline std::string_view take_word(std::string_view& line) {
    constexpr auto is_blank = [](char letter) { return letter == ' ' || letter == '\t' || letter == '\r'; };
    const auto* const begin = std::find_if_not(line.begin(), line.end(), is_blank);
    const auto* const end = std::find_if(begin, line.end(), is_blank);
    line = {end, line.end()};
    return {begin, end};
}

/// Appends the shortest text that reads back as the same number; of a whole number up to 1e15 its digits,
/// since programs that read whole numbers stop at the e of 1e+05.
template <class Number> void append_number(std::string& text, Number value) {
    std::array<char, 32> digits;
    char* const begin = digits.data();
    char* end = std::to_chars(begin, begin + digits.size(), value).ptr;
    if constexpr (std::is_floating_point_v<Number>) {
        if (std::abs(value) < Number(1e15) && value == std::trunc(value)) {
            end = std::to_chars(begin, begin + digits.size(), value, std::chars_format::fixed).ptr;
        }
    }
    text.append(begin, end);
}

template <class Number> std::string number_text(Number value) {
    std::string text;
    append_number(text, value);
    return text;
}

/// What was found, to stand in a message of one line: between quotes, not too long, letters that cannot be
/// printed as question marks.
inline std::string in_quotes(std::string_view found, std::size_t longest = 40) {
    std::string shown = "'";
    for (const char letter : found.substr(0, longest)) {
        shown += letter >= ' ' && letter <= '~' ? letter : '?';
    }
    return shown + (found.size() > longest ? "...'" : "'");
}

/// Breaks one line at its spaces so that it fits a terminal of 80 columns; what follows a break is indented
/// by so many of them. The end of the last line is in it.
inline std::string wrapped(std::string line, std::size_t indent) {
    constexpr std::size_t columns = 80;
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

/// The last line that is not empty, and that does not only name a help (as those of GNU's programs do) behind
/// another one.
inline std::string last_line(std::string_view text) {
    const auto line_before = [&text](std::size_t until) {
        const std::size_t end = text.substr(0, until).find_last_not_of(" \t\r\n");
        const std::size_t begin = end == std::string_view::npos ? 0 : text.rfind('\n', end) + 1;
        return end == std::string_view::npos ? std::string_view() : text.substr(begin, end + 1 - begin);
    };
    const std::string_view last = line_before(text.size());
    if (last.starts_with("Try '")) {
        const std::string_view other = line_before(static_cast<std::size_t>(last.data() - text.data()));
        return std::string(other.empty() ? last : other);
    }
    return std::string(last);
}

/// "1 disc", "2 discs".
template <class Count> std::string counted(Count count, const std::string& one) {
    return number_text(count) + " " + one + (count == 1 ? "" : "s");
}

} // namespace carom
