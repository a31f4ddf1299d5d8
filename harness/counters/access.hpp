#pragma once

#include <optional>
#include <string>

namespace carom {

/// What the kernel lets this process count, found out by opening one event of each kind.
struct PerfAccess {
    int hardware_error = 0;           ///< errno of counting cycles in user mode, 0 if it can be done
    int software_error = 0;           ///< errno of counting page faults in user mode
    int kernel_error = 0;             ///< errno of counting page faults in the kernel as well
    std::optional<int> paranoid = {}; ///< /proc/sys/kernel/perf_event_paranoid, empty if it cannot be read
    bool virtualised = false;
};

/// Finds it out now.
PerfAccess read_perf_access();

/// Whether the kernel drives no performance-monitoring unit (PMU) at all.
bool lacks_pmu(const PerfAccess& access);

/// Why something has no value, and what to do about it.
struct Explanation {
    std::string reason;
    std::string remedy;
};

/// Why an event of the source "papi-hardware" or "papi-software" cannot be counted: what the kernel refuses,
/// or else `error`, what PAPI said.
Explanation explain(const PerfAccess& access, const std::string& source, const std::string& error);

} // namespace carom
