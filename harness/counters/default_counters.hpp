#pragma once

#include <vector>

#include "harness/counters/groups.hpp"

namespace carom {

/// What is counted if nobody says otherwise: presets where PAPI has them for this CPU, otherwise the kernel's
/// own generic events.
inline std::vector<Alternatives> default_counters() {
    return {{"PAPI_TOT_CYC", "perf::CYCLES"},
            {"PAPI_TOT_INS", "perf::INSTRUCTIONS"},
            {"PAPI_L1_DCM", "perf::L1-DCACHE-LOAD-MISSES"},
            {"PAPI_L2_TCM", "PAPI_L2_DCM"},
            {"PAPI_L3_TCM", "perf::CACHE-MISSES"},
            {"PAPI_BR_MSP", "perf::BRANCH-MISSES"},
            {"PAPI_TLB_DM", "perf::DTLB-LOAD-MISSES"},
            {"PAPI_RES_STL", "perf::STALLED-CYCLES-BACKEND"},
            {"perf::TASK-CLOCK"},
            {"perf::CONTEXT-SWITCHES"},
            {"perf::CPU-MIGRATIONS"},
            {"perf::PAGE-FAULTS"}};
}

} // namespace carom
