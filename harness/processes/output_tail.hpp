#pragma once

#include <cstddef>
#include <optional>
#include <regex>
#include <span>
#include <string>

#include "harness/processes/process_end.hpp"

namespace carom {

/// More than one is one too many: they are kept to say how many there were, with the last in the place of
/// those that are beyond.
inline constexpr std::size_t most_lines_matched = 100;

/// The library's matcher calls itself for each character: a longer line could take it off the stack.
inline constexpr std::size_t longest_line_matched = 4096;

/// What a program prints, as it comes: its end is kept and the rest only counted, so that however much it is
/// takes no more memory. Lines that a pattern matches are kept as well, of up to 4096 bytes each.
class OutputTail {
  public:
    /// `pattern` is an ECMAScript expression, or empty. One that is none matches nothing: whoever takes a
    /// time from the lines says so.
    explicit OutputTail(const std::string& pattern);

    void take(std::span<const char> bytes);

    /// All of it, once nothing comes any more.
    Printed printed();

  private:
    void take_line_part(std::string_view part);
    void end_line();

    std::optional<std::regex> pattern_;
    Printed printed_;
    std::string line_;
    bool line_is_too_long_ = false;
};

} // namespace carom
