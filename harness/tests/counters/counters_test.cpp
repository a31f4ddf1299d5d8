#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/counters/access.hpp"
#include "harness/counters/counters.hpp"
#include "kernels/parallel_for.hpp"

namespace carom {
namespace {

constexpr int threads = 2;

void work(Stopwatch stopwatch) {
    stopwatch.start();
    on_each_thread(threads, [](int thread) {
        volatile double sum = 0;
        for (int i = 0; i < 2'000'000 * (thread + 1); ++i) {
            sum = sum + i;
        }
    });
    stopwatch.stop();
}

/// The rows of a source that have a value, by name and thread.
std::map<std::pair<std::string, int>, double> values(const std::vector<CounterValue>& rows,
                                                     const std::string& source) {
    std::map<std::pair<std::string, int>, double> found;
    for (const CounterValue& row : rows) {
        if (row.source == source && row.value && row.thread) {
            found[{row.name, *row.thread}] = *row.value;
        }
    }
    return found;
}

const CounterValue* missing(const std::vector<CounterValue>& rows, const std::string& name) {
    for (const CounterValue& row : rows) {
        if (row.name == name && !row.value) {
            return &row;
        }
    }
    return nullptr;
}

TEST(Counters, EachRowHasAValueOrAReasonAndARemedy) {
    const std::set<std::string> sources{"papi-hardware", "papi-software", "rusage"};
    for (const CounterValue& row : count({}, threads, work)) {
        EXPECT_TRUE(sources.contains(row.source)) << row.source;
        EXPECT_EQ(row.reason.empty(), row.value.has_value()) << row.name;
        EXPECT_EQ(row.remedy.empty(), row.value.has_value()) << row.name;
    }
}

TEST(Counters, GetrusageTellsTheCpuTimeOfEachThread) {
    auto found = values(count({}, threads, work), "rusage");
    const auto seconds = [&found](int thread) {
        return found.at({"user_seconds", thread}) + found.at({"system_seconds", thread});
    };
    EXPECT_GT(seconds(0), 0);
    EXPECT_GT(seconds(1), 0);
    EXPECT_LT(seconds(0), 60);
}

TEST(Counters, HardwareIsCountedOnEachThreadOrSaysWhyNot) {
    const auto rows = count({"PAPI_TOT_INS"}, threads, work);
    if (read_perf_access().hardware_error != 0) {
        const CounterValue* row = missing(rows, "PAPI_TOT_INS");
        ASSERT_NE(row, nullptr);
        EXPECT_EQ(row->source, "papi-hardware");
        EXPECT_NE(row->reason, "");
        return;
    }
    auto found = values(rows, "papi-hardware");
    if (found.empty()) {
        ASSERT_NE(missing(rows, "PAPI_TOT_INS"), nullptr);
        GTEST_SKIP() << "this PAPI does not know this CPU: " << missing(rows, "PAPI_TOT_INS")->reason;
    }
    EXPECT_GT(found.at({"PAPI_TOT_INS", 0}), 2e6);
    EXPECT_GT(found.at({"PAPI_TOT_INS", 1}), 4e6);
}

TEST(Counters, TheTaskClockRunsOnEachThreadOrSaysWhyNot) {
    const auto rows = count({"perf::TASK-CLOCK"}, threads, work);
    auto found = values(rows, "papi-software");
    if (found.empty()) {
        const CounterValue* row = missing(rows, "perf::TASK-CLOCK");
        ASSERT_NE(row, nullptr);
        GTEST_SKIP() << row->reason;
    }
    auto rusage = values(rows, "rusage");
    for (int thread = 0; thread < threads; ++thread) {
        const double clock = 1e-9 * found.at({"perf::TASK-CLOCK", thread});
        EXPECT_GT(clock, 0);
        // Counted in the same run, just inside, by another of the kernel's clocks.
        const double used = rusage.at({"user_seconds", thread}) + rusage.at({"system_seconds", thread});
        EXPECT_LE(clock, 1.05 * used + 0.005);
    }
}

TEST(Counters, AnUnknownEventIsMissingAndIsNoZero) {
    const auto rows = count({"PAPI_NO_SUCH_EVENT", "perf::NO-SUCH-EVENT"}, threads, work);
    for (const char* event : {"PAPI_NO_SUCH_EVENT", "perf::NO-SUCH-EVENT"}) {
        const CounterValue* row = missing(rows, event);
        ASSERT_NE(row, nullptr);
        EXPECT_FALSE(row->thread.has_value());
        EXPECT_NE(row->reason, "");
    }
    EXPECT_TRUE(values(rows, "papi-hardware").empty());
}

TEST(Counters, TheEnvironmentChoosesEventsAndTheCallerOverrulesIt) {
    setenv("PAPI_EVENTS", " PAPI_FIRST, PAPI_SECOND,,PAPI_FIRST", 1);
    const CounterPlan chosen = plan_counters({});
    const CounterPlan overruled = plan_counters({"PAPI_THIRD"});
    unsetenv("PAPI_EVENTS");
    ASSERT_EQ(chosen.missing.size(), 2U);
    EXPECT_EQ(chosen.missing[0].name, "PAPI_FIRST");
    EXPECT_EQ(chosen.missing[1].name, "PAPI_SECOND");
    ASSERT_EQ(overruled.missing.size(), 1U);
    EXPECT_EQ(overruled.missing[0].name, "PAPI_THIRD");
}

TEST(Counters, TheWorkRunsOncePerGroup) {
    int runs = 0;
    const CounterPlan plan = plan_counters({});
    count({}, threads, [&runs](Stopwatch stopwatch) {
        ++runs;
        work(std::move(stopwatch));
    });
    EXPECT_EQ(runs, static_cast<int>(std::max<std::size_t>(plan.groups.size(), 1)));
}

} // namespace
} // namespace carom
