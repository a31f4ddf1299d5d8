#include "harness/machine/noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <sstream>
#include <string>

#include "harness/machine/machine.hpp"
#include "harness/support/process_clock.hpp"

namespace carom {
namespace {

/// The same instructions every time, each waiting for the one before: xorshift64 (Marsaglia 2003).
std::uint64_t spin(int turns) {
    std::uint64_t state = 88172645463325252;
    for (int turn = 0; turn < turns; ++turn) {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
    }
    return state;
}

double timed_spin(int turns) {
    const double start = process_seconds();
    volatile std::uint64_t result = spin(turns);
    static_cast<void>(result);
    return process_seconds() - start;
}

/// As many turns as make a spin of about a millisecond: the fastest of a few trials, since noise only slows.
int turns_of_a_millisecond() {
    constexpr int trial = 100'000;
    double fastest = timed_spin(trial);
    for (int k = 0; k < 20; ++k) {
        fastest = std::min(fastest, timed_spin(trial));
    }
    return std::max(1, static_cast<int>(trial * 1e-3 / fastest));
}

} // namespace

std::optional<CpuTime> parse_cpu_time(std::string_view line) {
    std::istringstream fields{std::string(line)};
    std::string name;
    fields >> name;
    CpuTime time;
    int count = 0;
    // Guest time, fields 9 and 10, is part of user time already.
    for (double ticks = 0; count < 8 && fields >> ticks; ++count) {
        time.total += ticks;
        time.stolen = ticks;
        time.idle += count == 3 || count == 4 ? ticks : 0;
    }
    return name == "cpu" && count == 8 ? std::optional(time) : std::nullopt;
}

std::optional<CpuTime> read_cpu_time() { return parse_cpu_time(first_line("/proc/stat").value_or("")); }

std::optional<double> stolen_share(const std::optional<CpuTime>& before,
                                   const std::optional<CpuTime>& after) {
    if (!before || !after || after->total <= before->total) {
        return std::nullopt;
    }
    return (after->stolen - before->stolen) / (after->total - before->total);
}

Noise spread(std::vector<double> durations) {
    std::ranges::sort(durations);
    const auto quantile = [&durations](double share) {
        const auto rank = std::ceil(share * static_cast<double>(durations.size()));
        return durations[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
    };
    const double median = quantile(0.5);
    return {.spins = static_cast<int>(durations.size()),
            .median_seconds = median,
            .p95_over_median = quantile(0.95) / median,
            .max_over_median = durations.back() / median};
}

std::vector<Neighbours> neighbours(const std::vector<double>& durations) {
    constexpr std::size_t fewest = 16;
    constexpr double of_normal = 0.6745; ///< standard deviations within which half of all values lie
    std::vector<Neighbours> found;
    for (const std::size_t length : std::to_array<std::size_t>({1, 2, 5, 10, 20, 50, 100, 200})) {
        std::vector<double> logs;
        for (std::size_t at = 0; at + length <= durations.size(); at += length) {
            const auto begin = durations.begin() + static_cast<std::ptrdiff_t>(at);
            logs.push_back(
                std::log(std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(length), 0.0)));
        }
        std::vector<double> differences;
        for (std::size_t at = 1; at < logs.size(); at += 2) {
            differences.push_back(std::abs(logs[at] - logs[at - 1]));
        }
        if (differences.size() >= fewest) {
            const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
            std::ranges::nth_element(differences, middle);
            found.push_back({1e-3 * static_cast<double>(length), *middle / of_normal});
        }
    }
    return found;
}

Noise measure_noise(double seconds) {
    const int turns = turns_of_a_millisecond();
    const auto before = read_cpu_time();
    const double start = process_seconds();
    std::vector<double> durations;
    do {
        durations.push_back(timed_spin(turns));
    } while (process_seconds() - start < seconds);
    std::vector<Neighbours> found = neighbours(durations);
    Noise noise = spread(std::move(durations));
    noise.neighbours = std::move(found);
    noise.steal = stolen_share(before, read_cpu_time());
    return noise;
}

} // namespace carom
