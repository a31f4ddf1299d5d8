#include <cerrno>
#include <string>

#include <gtest/gtest.h>

#include "harness/counters/access.hpp"

namespace carom {
namespace {

TEST(CountersAccess, AVirtualMachineWithoutPmuSaysSo) {
    const PerfAccess access{.hardware_error = ENOENT, .paranoid = 2, .virtualised = true};
    EXPECT_TRUE(lacks_pmu(access));
    const Explanation why = explain(access, "papi-hardware", "unknown event");
    EXPECT_EQ(why.reason, "virtual machine without a performance-monitoring unit");
    EXPECT_NE(why.remedy.find("--simulated"), std::string::npos);
}

TEST(CountersAccess, AMachineWithoutPmuIsNotCalledVirtual) {
    const Explanation why = explain({.hardware_error = ENOENT, .virtualised = false}, "papi-hardware", "");
    EXPECT_EQ(why.reason.find("virtual"), std::string::npos) << why.reason;
    EXPECT_NE(why.reason.find("no performance-monitoring unit"), std::string::npos) << why.reason;
}

TEST(CountersAccess, ParanoiaIsNamedWithTheSettingThatHelps) {
    const PerfAccess access{
        .hardware_error = EACCES, .software_error = EACCES, .kernel_error = EACCES, .paranoid = 3};
    EXPECT_FALSE(lacks_pmu(access));
    for (const char* source : {"papi-hardware", "papi-software"}) {
        const Explanation why = explain(access, source, "");
        EXPECT_EQ(why.reason, "perf_event_paranoid is 3");
        EXPECT_NE(why.remedy.find("perf_event_paranoid=2"), std::string::npos) << why.remedy;
    }
}

TEST(CountersAccess, CountingInTheKernelNeedsLessParanoia) {
    const Explanation why = explain({.kernel_error = EACCES, .paranoid = 2}, "papi-software", "");
    EXPECT_EQ(why.reason, "perf_event_paranoid is 2");
    EXPECT_NE(why.remedy.find("perf_event_paranoid=1"), std::string::npos) << why.remedy;
}

TEST(CountersAccess, ARefusalThatParanoiaDoesNotExplainPointsToTheContainer) {
    const Explanation why = explain({.hardware_error = EPERM, .paranoid = 1}, "papi-hardware", "");
    EXPECT_NE(why.reason.find("although perf_event_paranoid is 1"), std::string::npos) << why.reason;
    EXPECT_NE(why.remedy.find("seccomp"), std::string::npos) << why.remedy;
}

TEST(CountersAccess, WhereTheKernelCountsThePapiErrorIsTheReason) {
    for (const char* source : {"papi-hardware", "papi-software"}) {
        const Explanation why = explain({}, source, "preset PAPI_X is unknown to PAPI 7.0.0 on this CPU");
        EXPECT_EQ(why.reason, "preset PAPI_X is unknown to PAPI 7.0.0 on this CPU");
        EXPECT_FALSE(why.remedy.empty());
    }
}

} // namespace
} // namespace carom
