#include "harness/processes/event_counts.hpp"

#include <cstdint>

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace carom {
int open_event(const CountedEvent& event, pid_t process, bool in_kernel) {
    perf_event_attr attributes{};
    attributes.size = sizeof attributes;
    attributes.type = event.type;
    attributes.config = event.config;
    attributes.disabled = 1;
    attributes.inherit = 1;
    attributes.enable_on_exec = 1;
    attributes.exclude_kernel = !in_kernel;
    attributes.exclude_hv = 1;
    attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
    constexpr int any_processor = -1;
    constexpr int no_group = -1;
    return static_cast<int>(
        syscall(SYS_perf_event_open, &attributes, process, any_processor, no_group, PERF_FLAG_FD_CLOEXEC));
}

const std::vector<CountedEvent>& hardware_events() {
    static const std::vector<CountedEvent> events{
        {"instructions", PERF_TYPE_HARDWARE, PERF_COUNT_HW_INSTRUCTIONS},
        {"cycles", PERF_TYPE_HARDWARE, PERF_COUNT_HW_CPU_CYCLES},
        {"cache_misses", PERF_TYPE_HARDWARE, PERF_COUNT_HW_CACHE_MISSES},
        {"branch_misses", PERF_TYPE_HARDWARE, PERF_COUNT_HW_BRANCH_MISSES}};
    return events;
}

EventCounts::EventCounts(pid_t process, const std::vector<CountedEvent>& events) {
    for (const CountedEvent& event : events) {
        if (const int descriptor = open_event(event, process); descriptor >= 0) {
            open_.push_back({event.name, descriptor});
        }
    }
}

EventCounts::~EventCounts() {
    for (const Open& one : open_) {
        close(one.descriptor);
    }
}

std::map<std::string, double> EventCounts::read() const {
    struct Counted {
        std::uint64_t value;
        std::uint64_t enabled;
        std::uint64_t running;
    };
    std::map<std::string, double> found;
    for (const Open& one : open_) {
        Counted counted{};
        const bool is_read = ::read(one.descriptor, &counted, sizeof counted) == sizeof counted;
        if (is_read && counted.enabled > 0 && counted.running == counted.enabled) {
            found.emplace(one.name, static_cast<double>(counted.value));
        }
    }
    return found;
}

} // namespace carom
