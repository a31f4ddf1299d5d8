#pragma once

#include <memory>
#include <string>

#include "harness/counters/event_set.hpp"

namespace carom {

/// The version of PAPI as 7.0.0.
std::string papi_version();

/// Whether PAPI has an event of that name, countable or not, on this machine; true if PAPI cannot be used at
/// all.
bool knows_event(const std::string& event);

/// Whether the kernel counts PAPI's event by itself, such as perf::TASK-CLOCK.
bool is_software_event(const std::string& event);

/// Where software or hardware is at work while it is counted.
enum class CountedMode {
    user,
    user_and_kernel, ///< as far as that is allowed
};

/// Counts PAPI's presets and native events for the calling thread, in a mode. PAPI is initialised at the
/// first call. Throws CounterError if it cannot be.
std::unique_ptr<EventSet> papi_event_set(CountedMode mode);

} // namespace carom
