#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <regex>
#include <span>
#include <string>
#include <string_view>

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
    explicit OutputTail(const std::string& pattern) {
        if (!pattern.empty()) {
            try {
                pattern_.emplace(pattern);
            } catch (const std::regex_error&) {
                pattern_.reset();
            }
        }
    }

    void take(std::span<const char> bytes) {
        printed_.bytes += static_cast<std::int64_t>(bytes.size());
        printed_.end.append(bytes.data(), bytes.size());
        if (printed_.end.size() > 2 * kept_bytes) {
            printed_.end.erase(0, printed_.end.size() - kept_bytes);
        }
        std::string_view rest(bytes.data(), bytes.size());
        while (pattern_ && !rest.empty()) {
            const auto end = rest.find('\n');
            take_line_part(rest.substr(0, end));
            if (end == std::string_view::npos) {
                return;
            }
            end_line();
            rest.remove_prefix(end + 1);
        }
    }

    /// All of it, once nothing comes any more.
    Printed printed() {
        if (!line_.empty()) {
            end_line();
        }
        if (printed_.end.size() > kept_bytes) {
            printed_.end.erase(0, printed_.end.size() - kept_bytes);
        }
        return printed_;
    }

  private:
    static constexpr std::size_t kept_bytes = 65536;

    void take_line_part(std::string_view part) {
        line_is_too_long_ = line_is_too_long_ || line_.size() + part.size() > longest_line_matched;
        if (!line_is_too_long_) {
            line_ += part;
        }
    }

    void end_line() {
        if (pattern_ && !line_is_too_long_ && std::regex_search(line_, *pattern_)) {
            printed_.matched.resize(std::min(printed_.matched.size() + 1, most_lines_matched));
            printed_.matched.back() = line_;
        }
        line_.clear();
        line_is_too_long_ = false;
    }

    std::optional<std::regex> pattern_;
    Printed printed_;
    std::string line_;
    bool line_is_too_long_ = false;
};

} // namespace carom
