#pragma once

#include <string>
#include <utility>
#include <vector>

#include <sys/resource.h>

#include "harness/support/process_clock.hpp"

namespace carom {

/// What the system keeps count of by itself (getrusage(2)), by name.
inline std::vector<std::pair<std::string, double>> counts_of(const rusage& usage) {
    return {{"user_seconds", seconds_of(usage.ru_utime)},
            {"system_seconds", seconds_of(usage.ru_stime)},
            {"minor_page_faults", static_cast<double>(usage.ru_minflt)},
            {"major_page_faults", static_cast<double>(usage.ru_majflt)},
            {"voluntary_context_switches", static_cast<double>(usage.ru_nvcsw)},
            {"involuntary_context_switches", static_cast<double>(usage.ru_nivcsw)}};
}

} // namespace carom
