#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/counters/event_set.hpp"
#include "harness/support/stopwatch.hpp"

namespace carom {

/// One counter on one thread, or why it has no value.
struct CounterValue {
    std::string name;          ///< of the event, as its source calls it
    std::optional<int> thread; ///< empty where the source cannot tell threads apart, or nothing was counted
    std::optional<double> value;
    std::string source;      ///< papi-hardware, papi-software, rusage or cachegrind
    std::string reason = {}; ///< why there is no value; empty if there is one
    std::string remedy = {};
};

/// One whole run on the threads asked for; what counts is what lies between starts and stops of the
/// stopwatch.
using CountedWork = std::function<void(Stopwatch)>;

/// Events of one source that are counted in one run.
struct CounterGroup {
    std::string source;
    std::vector<std::string> events;
    MakeEventSet make;
};

/// What can be counted on the calling thread, and what cannot and why.
struct CounterPlan {
    std::vector<CounterGroup> groups;
    std::vector<CounterValue> missing;
};

/// Finds out by adding, starting and reading each event. Without `events` those are taken from the
/// environment variable PAPI_EVENTS (separated by commas), and without it from the usual ones: cycles,
/// instructions, cache, branch and TLB misses, stalls, and the kernel's task clock, context switches,
/// migrations and page faults.
CounterPlan plan_counters(const std::vector<std::string>& events);

/// Runs the work once for each group of events, nothing multiplexed, and returns one row an event and thread,
/// and one a missing event. The first run also tells what getrusage knows. Hardware events are counted in
/// user mode. Throws CheckError if a thread reports nothing.
std::vector<CounterValue> count(const std::vector<std::string>& events, int threads, const CountedWork& run);

} // namespace carom
