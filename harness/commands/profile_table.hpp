#pragma once

#include <string>

#include "harness/measure/measurement.hpp"
#include "harness/records/profile_json.hpp"

namespace carom {

/// Prints a profile on standard output: phases with their balance, threads, counters, and what could not be
/// counted.
void print_profile(const Profile& profile, const Measurement& measurement);

/// What profiling cost, as the ratio of the times of the profiled and the bare run; with a word of doubt
/// where that is no cost.
std::string cost_text(double cost);

} // namespace carom
