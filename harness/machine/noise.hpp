#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace carom {

/// How much the time of the same work differs between two stretches one after the other.
struct Neighbours {
    double seconds;    ///< what a stretch takes
    double difference; ///< standard deviation of the logarithm of their ratio, from its middle half
};

/// How evenly the machine does the same work again and again.
struct Noise {
    int spins = 0;
    double median_seconds = 0;  ///< of one spin
    double p95_over_median = 0; ///< 95th percentile over median
    double max_over_median = 0;
    std::optional<double> steal =
        {}; ///< share of all CPUs' time that the host gave to others; empty if not told
    std::vector<Neighbours> neighbours = {}; ///< by the length of a stretch, as far as there are enough of it
};

/// The differences of neighbours among these durations, each of about a millisecond, in their order: joined
/// to stretches of 1, 2, 5 ... 200. What takes turns is compared with its neighbours, so that turns are best
/// as short as the least of difference times the root of the length, which is what a given time leaves open.
std::vector<Neighbours> neighbours(const std::vector<double>& durations);

/// Does a fixed spin of about a millisecond for so many seconds on the calling thread, and looks at the clock
/// after each.
Noise measure_noise(double seconds);

/// The spread of these durations, in seconds; there must be one at least. `steal` is left empty.
Noise spread(std::vector<double> durations);

/// CPU time since the machine started, in clock ticks.
struct CpuTime {
    double total = 0;
    double stolen = 0;
    double idle = 0; ///< with nothing to do, or waiting for disks
};

/// From the first line of /proc/stat (man proc_stat); empty if it is no such line.
std::optional<CpuTime> parse_cpu_time(std::string_view line);

/// Reads it now; empty if the system does not tell.
std::optional<CpuTime> read_cpu_time();

/// The share of the time between that was stolen; empty if either is, or if no time has passed.
std::optional<double> stolen_share(const std::optional<CpuTime>& before, const std::optional<CpuTime>& after);

} // namespace carom
