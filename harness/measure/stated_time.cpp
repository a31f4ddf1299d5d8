#include "harness/measure/stated_time.hpp"

#include <algorithm>
#include <array>
#include <regex>
#include <sstream>
#include <string_view>
#include <vector>

#include "harness/support/errors.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

/// The library's matcher calls itself for each character: a longer line could take it off the stack.
constexpr std::size_t longest_line = 4096;

/// What `real_time` of several threads is, of a version of the library.
enum class RealTime { divided_by_threads, whole, not_known };

/// Its three numbers, as in v1.9.1 or v1.9.1-4-g8b3f2a6; empty if it is no such text.
std::optional<std::array<int, 3>> numbers_of(std::string_view version) {
    std::array<int, 3> numbers{};
    version.remove_prefix(version.starts_with('v') ? 1 : 0);
    for (int& number : numbers) {
        const std::size_t length = std::min(version.find_first_not_of("0123456789"), version.size());
        const auto parsed = parse_number<int>(version.substr(0, length));
        if (!parsed) {
            return std::nullopt;
        }
        number = *parsed;
        version.remove_prefix(std::min(length + 1, version.size()));
    }
    return numbers;
}

/// Reports did not name a version before some 1.8. Not known is what was made between 1.8.5 and 1.9.1, and
/// what was built from a source without its history, which calls itself v0.0.0.
RealTime real_time_of(const std::optional<std::string>& version) {
    constexpr std::array last_divided{1, 8, 5};
    constexpr std::array first_whole{1, 9, 1};
    if (!version) {
        return RealTime::divided_by_threads;
    }
    const auto numbers = numbers_of(*version);
    const bool is_beyond = numbers == last_divided && version->find('-') != std::string::npos;
    if (!numbers || *numbers == std::array{0, 0, 0} || is_beyond) {
        return RealTime::not_known;
    }
    if (*numbers <= last_divided) {
        return RealTime::divided_by_threads;
    }
    return *numbers >= first_whole ? RealTime::whole : RealTime::not_known;
}

std::regex regex_of(const std::string& pattern) {
    std::regex regex;
    try {
        regex.assign(pattern);
    } catch (const std::regex_error&) {
        throw InputError("time: found '" + pattern + "', expected a regular expression");
    }
    if (regex.mark_count() != 1) {
        throw InputError("time: found '" + pattern + "', expected a regular expression with one group");
    }
    return regex;
}

bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

/// Does a number go on after `rest` has begun: a digit, or a point, a comma or an exponent with one behind
/// it?
bool goes_on(std::string_view rest) {
    if (rest.empty() || is_digit(rest.front())) {
        return !rest.empty();
    }
    const bool has_more =
        rest.size() > 1 && std::string_view(".,eE").find(rest.front()) != std::string_view::npos;
    const bool is_exponent = has_more && (rest.front() == 'e' || rest.front() == 'E');
    const std::size_t at = is_exponent && rest.size() > 2 && (rest[1] == '-' || rest[1] == '+') ? 2 : 1;
    return has_more && is_digit(rest[at]);
}

/// Has a number begun before `before` ends: with a digit, or with one before a point or a comma?
bool has_begun(std::string_view before) {
    if (before.empty()) {
        return false;
    }
    const bool after_point = before.size() > 1 && (before.back() == '.' || before.back() == ',');
    return is_digit(after_point ? before[before.size() - 2] : before.back());
}

/// What the group took, which must not be a part of a longer number, unless the pattern says what stands
/// beside it.
std::string number_in(const std::string& line, const std::smatch& match) {
    const std::string_view whole(line);
    const auto begin = static_cast<std::size_t>(match.position(1));
    const std::size_t end = begin + static_cast<std::size_t>(match.length(1));
    const bool cut_before = match.position(0) == match.position(1) && has_begun(whole.substr(0, begin));
    const bool cut_after = match[0].second == match[1].second && goes_on(whole.substr(end));
    const bool is_number = parse_number<double>(match[1].str()).has_value();
    if (is_number && (cut_before || cut_after)) {
        throw InputError("time: found " + in_quotes(match[1].str()) + " within a longer number in " +
                         in_quotes(line) + ", expected a pattern that takes all of it");
    }
    return match[1];
}

} // namespace

void require_pattern(const std::string& pattern) { regex_of(pattern); }

StatedTime time_in_output(const std::string& output, const std::string& pattern, double unit_seconds) {
    const std::regex regex = regex_of(pattern);
    std::vector<std::string> found;
    std::istringstream lines(output);
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (line.size() <= longest_line && std::regex_search(line, match, regex)) {
            found.push_back(number_in(line, match));
        }
    }
    if (found.size() != 1) {
        throw InputError("time: '" + pattern + "' matches " + std::to_string(found.size()) +
                         " lines of standard output, expected one");
    }
    const auto number = parse_number<double>(found.front());
    if (!number || !(*number > 0)) {
        throw InputError("time: found '" + found.front() + "', expected a positive number");
    }
    StatedTime time;
    time.seconds = *number * unit_seconds;
    return time;
}

std::optional<std::string> unlike_times(const StatedTime& one, const StatedTime& other) {
    const RealTime meaning = real_time_of(one.library_version);
    const RealTime other_meaning = real_time_of(other.library_version);
    const bool alike = one.library_version == other.library_version ||
                       (meaning == other_meaning && meaning != RealTime::not_known);
    if (std::max(one.threads, other.threads) == 1 || alike) {
        return std::nullopt;
    }
    const auto text = [](const StatedTime& time) {
        return time.library_version ? in_quotes(*time.library_version) : std::string("without a version");
    };
    return "Google Benchmark " + text(one) + " beside " + text(other) +
           ": of a case on several threads they do not mean the same by real_time (before 1.9 it is divided "
           "by "
           "the number of threads); build both with one version";
}

} // namespace carom
