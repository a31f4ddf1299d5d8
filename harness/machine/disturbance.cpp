#include "harness/machine/disturbance.hpp"

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "harness/machine/machine.hpp"
#include "harness/machine/threads.hpp"
#include "harness/support/format.hpp"
#include "harness/support/note.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

/// Less is told by no clock tick, or is what a quiet machine does as well.
constexpr double shortest_wait = 0.002;
constexpr double shortest_time_for_ticks = 0.2;
constexpr double share_to_tell = 0.05;

/// Seconds that the threads of this process were ready to run without running: the second number of schedstat
/// (Documentation/scheduler/sched-stats.rst of Linux), in nanoseconds. Empty where the kernel keeps no count.
std::optional<double> waited_seconds() {
    std::optional<double> sum;
    std::error_code error;
    std::filesystem::directory_iterator thread("/proc/self/task", error);
    for (; !error && thread != std::filesystem::directory_iterator(); thread.increment(error)) {
        std::istringstream numbers(first_line(thread->path() / "schedstat").value_or(""));
        double ran = 0;
        double waited = 0;
        if (numbers >> ran >> waited) {
            sum = sum.value_or(0) + 1e-9 * waited;
        }
    }
    return sum;
}

std::optional<double> load_of_last_minute() {
    double load = 0;
    return getloadavg(&load, 1) == 1 ? std::optional(load) : std::nullopt;
}

} // namespace

std::optional<std::string> busy_text(const Disturbance& disturbance, int threads) {
    const double told = share_to_tell * disturbance.seconds;
    const bool waited = disturbance.waited && threads <= disturbance.processors &&
                        *disturbance.waited > told && *disturbance.waited > shortest_wait;
    const bool stolen = disturbance.stolen && *disturbance.stolen > share_to_tell;
    if (!waited && !stolen) {
        return std::nullopt;
    }
    std::string text = "the machine was busy: ";
    if (waited) {
        text += format("threads were kept waiting for a processor, %.2g s together in %.2g s",
                       *disturbance.waited, disturbance.seconds);
    }
    if (stolen) {
        text += format("%s%.0f %% of its time went to other machines of its host", waited ? ", " : "",
                       100 * *disturbance.stolen);
    }
    if (disturbance.load) {
        text += format(" (load %.1f on %s)", *disturbance.load,
                       counted(disturbance.processors, "processor").c_str());
    }
    return text + "; on a quiet one this takes less time";
}

DisturbanceWatch::DisturbanceWatch()
    : start_(process_seconds()), waited_(waited_seconds()), time_(read_cpu_time()) {}

Disturbance DisturbanceWatch::until_now() const {
    Disturbance disturbance{.seconds = process_seconds() - start_,
                            .waited = waited_seconds(),
                            .stolen = {},
                            .load = load_of_last_minute(),
                            .processors = usable_processors()};
    if (disturbance.waited) {
        *disturbance.waited -= waited_.value_or(0);
    }
    if (disturbance.seconds > shortest_time_for_ticks) {
        disturbance.stolen = stolen_share(time_, read_cpu_time());
    }
    return disturbance;
}

void note_if_busy(const DisturbanceWatch& watch, int threads) {
    if (const auto text = busy_text(watch.until_now(), threads)) {
        note(*text);
    }
}

} // namespace carom
