#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/counters/event_set.hpp"

namespace carom {

/// What the system itself keeps count of for each thread: `user_seconds`, `system_seconds`,
/// `minor_page_faults`, `major_page_faults`, `voluntary_context_switches`, `involuntary_context_switches`.
std::vector<std::string> rusage_events();

/// Counts them for the calling thread, by getrusage(RUSAGE_THREAD).
std::unique_ptr<EventSet> rusage_event_set();

/// The most memory that the process has had resident so far, in bytes; the system does not tell it by thread.
double maximum_resident_bytes();

} // namespace carom
