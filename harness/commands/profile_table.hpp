#pragma once

#include "harness/records/profile_json.hpp"
#include "harness/records/record.hpp"

namespace carom {

/// Prints a profile on standard output: phases with their balance, threads, counters, and what could not be
/// counted.
void print_profile(const Profile& profile, const Measurement& measurement);

} // namespace carom
