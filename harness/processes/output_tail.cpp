#include "harness/processes/output_tail.hpp"

#include <algorithm>
#include <string_view>

namespace carom {
namespace {

constexpr std::size_t kept_bytes = 65536;

} // namespace

OutputTail::OutputTail(const std::string& pattern) {
    if (!pattern.empty()) {
        try {
            pattern_.emplace(pattern);
        } catch (const std::regex_error&) {
            pattern_.reset();
        }
    }
}

void OutputTail::take(std::span<const char> bytes) {
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

Printed OutputTail::printed() {
    if (!line_.empty()) {
        end_line();
    }
    if (printed_.end.size() > kept_bytes) {
        printed_.end.erase(0, printed_.end.size() - kept_bytes);
    }
    return printed_;
}

void OutputTail::take_line_part(std::string_view part) {
    line_is_too_long_ = line_is_too_long_ || line_.size() + part.size() > longest_line_matched;
    if (!line_is_too_long_) {
        line_ += part;
    }
}

void OutputTail::end_line() {
    if (pattern_ && !line_is_too_long_ && std::regex_search(line_, *pattern_)) {
        printed_.matched.resize(std::min(printed_.matched.size() + 1, most_lines_matched));
        printed_.matched.back() = line_;
    }
    line_.clear();
    line_is_too_long_ = false;
}

} // namespace carom
