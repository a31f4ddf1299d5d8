#include "harness/measure/stated_time.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "harness/support/text.hpp"

namespace carom {
namespace {

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

} // namespace

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
