#include <cerrno>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/counters/access.hpp"

namespace carom {
namespace {

struct AccessCase {
    PerfAccess access;
    std::vector<std::string> sources;
    std::string reason;
    std::string remedy; ///< a part of it
    bool has_no_pmu = false;
};

TEST(CountersAccess, WhatTheKernelRefusesIsExplainedWithItsRemedy) {
    const std::string unknown = "preset PAPI_X is unknown to PAPI 7.0.0 on this CPU";
    const std::vector<AccessCase> cases{
        {{.hardware_error = ENOENT, .paranoid = 2, .virtualised = true},
         {"papi-hardware"},
         "virtual machine without a performance-monitoring unit",
         "--simulated",
         true},
        {{.hardware_error = ENOENT},
         {"papi-hardware"},
         "the kernel drives no performance-monitoring unit of this CPU",
         "--simulated",
         true},
        {{.hardware_error = EACCES, .software_error = EACCES, .kernel_error = EACCES, .paranoid = 3},
         {"papi-hardware", "papi-software"},
         "perf_event_paranoid is 3",
         "perf_event_paranoid=2"},
        {{.kernel_error = EACCES, .paranoid = 2},
         {"papi-software"},
         "perf_event_paranoid is 2",
         "perf_event_paranoid=1"},
        {{.hardware_error = EPERM, .paranoid = 1},
         {"papi-hardware"},
         "perf_event_open is refused although perf_event_paranoid is 1",
         "seccomp"},
        {{}, {"papi-hardware", "papi-software"}, unknown, "PAPI"}};
    for (const AccessCase& one : cases) {
        EXPECT_EQ(lacks_pmu(one.access), one.has_no_pmu) << one.reason;
        for (const std::string& source : one.sources) {
            const Explanation why = explain(one.access, source, unknown);
            EXPECT_EQ(why.reason, one.reason);
            EXPECT_PRED_FORMAT2(testing::IsSubstring, one.remedy, why.remedy);
        }
    }
}

} // namespace
} // namespace carom
