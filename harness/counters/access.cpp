#include "harness/counters/access.hpp"

#include <cerrno>
#include <cstring>

#include <linux/perf_event.h>
#include <unistd.h>

#include "harness/machine/machine.hpp"
#include "harness/processes/event_counts.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

/// errno of opening the event for the calling thread, or 0.
int try_opening(const CountedEvent& event, bool in_kernel) {
    const int descriptor = open_event(event, 0, in_kernel);
    if (descriptor < 0) {
        return errno;
    }
    close(descriptor);
    return 0;
}

/// The largest perf_event_paranoid at which Linux lets a process without privileges count: 2 in user mode, 1
/// in the kernel as well. Distributions know 3 and more, which refuse everything.
Explanation explain_refusal(const PerfAccess& access, int most_paranoid) {
    if (access.paranoid && *access.paranoid > most_paranoid) {
        return {"perf_event_paranoid is " + std::to_string(*access.paranoid),
                "as root: sysctl kernel.perf_event_paranoid=" + std::to_string(most_paranoid)};
    }
    return {"perf_event_open is refused although perf_event_paranoid is " +
                (access.paranoid ? std::to_string(*access.paranoid) : "not readable"),
            "a container needs perf_event_open in its seccomp profile, or CAP_PERFMON"};
}

Explanation explain_error(const PerfAccess& access, int error, int most_paranoid) {
    if (error == EACCES || error == EPERM) {
        return explain_refusal(access, most_paranoid);
    }
    if (error == ENOSYS) {
        return {"this kernel has no perf_event_open", "a kernel with CONFIG_PERF_EVENTS"};
    }
    return {std::string("perf_event_open: ") + std::strerror(error), "see man perf_event_open"};
}

} // namespace

PerfAccess read_perf_access() {
    PerfAccess access;
    access.hardware_error = try_opening({"cycles", PERF_TYPE_HARDWARE, PERF_COUNT_HW_CPU_CYCLES}, false);
    const CountedEvent page_faults{"page_faults", PERF_TYPE_SOFTWARE, PERF_COUNT_SW_PAGE_FAULTS};
    access.software_error = try_opening(page_faults, false);
    access.kernel_error = try_opening(page_faults, true);
    if (const auto line = first_line("/proc/sys/kernel/perf_event_paranoid")) {
        access.paranoid = parse_number<int>(*line);
    }
    access.virtualised = read_machine()["virtualised"];
    return access;
}

bool lacks_pmu(const PerfAccess& access) {
    return access.hardware_error == ENOENT || access.hardware_error == EOPNOTSUPP ||
           access.hardware_error == ENODEV;
}

Explanation explain(const PerfAccess& access, const std::string& source, const std::string& error) {
    if (source == "papi-software") {
        if (access.software_error != 0) {
            return explain_error(access, access.software_error, 2);
        }
        if (access.kernel_error != 0) {
            return explain_error(access, access.kernel_error, 1);
        }
        return {error, "the rusage rows count much of the same; a newer PAPI may know this machine"};
    }
    if (lacks_pmu(access)) {
        return access.virtualised
                   ? Explanation{"virtual machine without a performance-monitoring unit",
                                 "a host that passes its PMU on (KVM: -cpu host,pmu=on), bare metal, or "
                                 "`carom profile --simulated`"}
                   : Explanation{
                         "the kernel drives no performance-monitoring unit of this CPU",
                         "a kernel or firmware setting that enables it, or `carom profile --simulated`"};
    }
    if (access.hardware_error != 0) {
        return explain_error(access, access.hardware_error, 2);
    }
    return {error, "an event from `papi_avail -a` or `papi_native_avail`, or a newer PAPI"};
}

} // namespace carom
