#include "harness/side_by_side/stopping.hpp"

#include <algorithm>
#include <functional>
#include <string>

#include <unistd.h>

#include "harness/machine/noise.hpp"
#include "harness/support/format.hpp"

namespace carom {
namespace {

constexpr double least_busy = 0.5;
constexpr double least_idle = 0.5;
constexpr double shortest_to_tell = 0.002;

/// Another speed of the machine changes the time by any factor, though rarely three times in a row.
constexpr double margin_of_time = 1.1;
/// It changes time and CPU time alike: their quotient tells of waiting.
constexpr double margin_of_waiting = 1.05;
/// Of less CPU time than some ticks the quotient is noise.
constexpr double least_cpu_seconds = 0.05;

double waiting(const ProcessEnd& end) {
    return end.cpu_seconds() > least_cpu_seconds ? end.own_seconds() / end.cpu_seconds() : 1;
}

double time(const ProcessEnd& end) { return end.own_seconds(); }

bool apart(const std::vector<ProcessEnd>& ones, const std::vector<ProcessEnd>& others,
           const std::function<double(const ProcessEnd&)>& value, double margin) {
    const auto [least, most] = std::ranges::minmax(ones, {}, value);
    const auto [least_other, most_other] = std::ranges::minmax(others, {}, value);
    return value(most) * margin < value(least_other) || value(most_other) * margin < value(least);
}

} // namespace

double idle_seconds_of_machine() {
    const auto cpu = read_cpu_time();
    return cpu ? cpu->idle / static_cast<double>(sysconf(_SC_CLK_TCK)) : 0;
}

std::string why_idle(const ProcessEnd& undisturbed, double idle_processors) {
    const double busy = undisturbed.cpu_seconds() / undisturbed.wall_seconds();
    if (undisturbed.wall_seconds() < shortest_to_tell || busy >= least_busy || idle_processors < least_idle) {
        return "";
    }
    return format(
        "it computes for only %.0f %% of its time, and what it waits for would go on while it stands still",
        100 * busy);
}

bool may_disagree(const std::vector<ProcessEnd>& undisturbed, const std::vector<ProcessEnd>& in_slices) {
    return apart(undisturbed, in_slices, time, margin_of_time) ||
           apart(undisturbed, in_slices, waiting, margin_of_waiting);
}

std::string how_they_disagree(const std::vector<ProcessEnd>& undisturbed,
                              const std::vector<ProcessEnd>& in_slices) {
    const auto shortest = [](const std::vector<ProcessEnd>& ends) {
        return time(std::ranges::min(ends, {}, time));
    };
    return format(
        "it takes another time where it is stopped now and then and the others stand still while it "
        "runs: %.3g s without a pause, %.3g s in slices",
        shortest(undisturbed), shortest(in_slices));
}

} // namespace carom
