#pragma once

#include "harness/measure/measurement.hpp"
#include "harness/records/profile_json.hpp"

namespace carom {

/// Prints a profile on standard output: phases with their balance, threads, counters, and what could not be
/// counted.
void print_profile(const Profile& profile, const Measurement& measurement);

} // namespace carom
