#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/processes/process_end.hpp"

namespace carom {

/// Whether a program minds being stopped now and then, from runs without a pause and runs in slices.

/// So many of either kind before it is said that it does.
inline constexpr std::size_t runs_to_be_sure = 3;

/// Why it is not to be stopped, since it waits for most of its time; empty if it does not, or if nobody can
/// tell: of a program of less than two milliseconds, and where it may have waited for a processor, as all of
/// them were busy. `idle_processors` is how many were not, on average, while it ran.
std::string why_idle(const ProcessEnd& undisturbed, double idle_processors);

/// The time that all processors together have had nothing to do since the machine was started, in seconds; 0
/// where the system does not tell it.
double idle_seconds_of_machine();

/// Whether all runs in slices are so much shorter, or so much longer, than all without a pause that noise
/// does not explain it. What they waited for a processor does not count.
bool may_disagree(const std::vector<ProcessEnd>& undisturbed, const std::vector<ProcessEnd>& in_slices);

/// The same in words, with the times.
std::string how_they_disagree(const std::vector<ProcessEnd>& undisturbed,
                              const std::vector<ProcessEnd>& in_slices);

} // namespace carom
