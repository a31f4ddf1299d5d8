#include <gtest/gtest.h>

#include "harness/machine/limits.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

constexpr std::int64_t kibi = 1024;
constexpr std::int64_t mebi = 1024 * kibi;
constexpr std::int64_t gibi = 1024 * mebi;

/// Four cores of two hardware threads each, and two caches of the last level.
Topology four_cores() {
    return {.source = "a test",
            .packages = 1,
            .cores = 4,
            .hardware_threads = 8,
            .numa_nodes = 1,
            .caches = {{.name = "L1d", .bytes = 32 * kibi, .count = 4, .hardware_threads = 2},
                       {.name = "L1i", .bytes = 64 * kibi, .count = 4, .hardware_threads = 2},
                       {.name = "L2", .bytes = 2 * mebi, .count = 4, .hardware_threads = 2},
                       {.name = "L3", .bytes = 16 * mebi, .count = 2, .hardware_threads = 4}}};
}

/// The levels of the sets of 32 KiB, 128 KiB, ... in one line.
std::string levels_of(const std::vector<WorkingSet>& sets) {
    std::string levels;
    for (const WorkingSet& set : sets) {
        levels += (levels.empty() ? "" : " ") + set.level;
    }
    return levels;
}

TEST(WorkingSets, GrowByFactorsOfFourUpToEightTimesTheLastLevel) {
    const auto sets = working_sets(four_cores(), 64 * gibi, 1);
    ASSERT_EQ(sets.size(), 8U);
    for (std::size_t k = 0; k + 1 < sets.size(); ++k) {
        EXPECT_EQ(sets[k].bytes, (32 * kibi) << (2 * k));
    }
    EXPECT_EQ(sets.back().bytes, 256 * mebi);
    EXPECT_EQ(working_sets(four_cores(), 13 * mebi, 1).back().bytes, 13 * mebi) << "no more than they may";
}

TEST(WorkingSets, AreInTheSmallestLevelOfDataCacheThatHoldsThem) {
    Topology unknown = four_cores();
    unknown.caches.clear();
    const std::string by_all = "L1d L1d L2 L2 L2 L3 memory memory";
    EXPECT_EQ(levels_of(working_sets(four_cores(), 64 * gibi, 1)), "L1d L2 L2 L2 L3 memory memory memory");
    EXPECT_EQ(levels_of(working_sets(four_cores(), 64 * gibi, 8)), by_all);
    EXPECT_EQ(levels_of(working_sets(four_cores(), 64 * gibi, 100)), by_all) << "no more than there is";
    EXPECT_EQ(levels_of(working_sets(unknown, 64 * gibi, 2)),
              "memory memory memory memory memory memory memory memory");
}

void expect_a_rate(const Rate& rate) {
    EXPECT_GT(rate.median, 0);
    EXPECT_GE(rate.best, rate.median);
    EXPECT_GE(rate.repetitions, 5);
}

TEST(Copy, IsRepeatedAsOftenAsTheTimeAllows) {
    expect_a_rate(measure_copy({"L2", mebi}, 1, 0));
    EXPECT_EQ(measure_copy({"L2", mebi}, 1, 0).repetitions, 5);
    // Beside other work five may take however long.
    int repetitions = 5;
    for (double seconds = 0.1; repetitions == 5 && seconds < 30; seconds *= 2) {
        repetitions = measure_copy({"L2", mebi}, 2, seconds).repetitions;
    }
    EXPECT_GT(repetitions, 5);
}

TEST(Copy, InACacheIsNotSlowerThanInMemory) {
    bool as_fast = false;
    for (int attempt = 0; attempt < 20 && !as_fast; ++attempt) {
        const double in_cache = measure_copy({"L1d", 32 * kibi}, 1, 0.05).best;
        const double in_memory = measure_copy({"memory", 64 * mebi}, 1, 0.05).best;
        as_fast = in_cache > 0.7 * in_memory;
    }
    EXPECT_TRUE(as_fast);
}

TEST(Copy, OfLessThanADoubleAThreadCopiesOneForEach) { expect_a_rate(measure_copy({"L1d", 1}, 3, 0)); }

TEST(Arithmetic, OfAWholeRegisterIsFasterThanOfOneDouble) {
    ASSERT_EQ(lanes(Arithmetic::scalar), 1);
    ASSERT_GE(lanes(Arithmetic::vector), 2);
    // Others may have the processor while either is measured.
    bool faster = false;
    for (int attempt = 0; attempt < 20 && !faster; ++attempt) {
        const Rate scalar = measure_arithmetic(Arithmetic::scalar, 1, 0.05);
        const Rate vector = measure_arithmetic(Arithmetic::vector, 1, 0.05);
        expect_a_rate(scalar);
        expect_a_rate(vector);
        faster = vector.best > 1.2 * scalar.best;
    }
    EXPECT_TRUE(faster);
}

TEST(LimitsText, SaysWhatWasMeasuredAndInWhichUnits) {
    EXPECT_EQ(limits_text(nlohmann::ordered_json::parse(R"({
                  "copy": [{"level": "memory", "working_set_bytes": 268435456, "threads": 2,
                            "bytes_per_second": {"best": 12.5e9, "median": 12e9, "repetitions": 7}}],
                  "arithmetic": [{"lanes": 2, "threads": 1, "operations_per_second": {
                                      "best": 12.5e9, "median": 12e9, "repetitions": 7}}]})")),
              "best rates\n"
              "copy within  262144 KiB, memory   2 threads      12.5 GB/s (median 12 of 7)\n"
              "x * a + b, 2 at once             1 thread       12.5 Gflop/s (median 12 of 7)\n");
}

TEST(LimitsCommand, MeasuresEveryNumberOfThreadsAndRecordsWhatItPrints) {
    const tests::TemporaryDirectory directory;
    const auto result =
        tests::run_carom({"limits", "--threads", "2", "--seconds", "0", "--memory", "4", "--json", "--record",
                          directory / "limits.json", "--tag", "site=local"});
    EXPECT_EQ(result.exit_code, 0) << result.error;
    const nlohmann::ordered_json printed = nlohmann::ordered_json::parse(result.output, nullptr, false);
    ASSERT_TRUE(printed.is_object()) << result.output;
    for (const char* part : {"copy", "arithmetic"}) {
        EXPECT_EQ(printed[part].front()["threads"], 1);
        EXPECT_EQ(printed[part].back()["threads"], 2);
    }
    EXPECT_EQ(printed["copy"].front()["working_set_bytes"], 32 * kibi);
    EXPECT_EQ(printed["copy"].back()["working_set_bytes"], 4 * mebi);
    const nlohmann::ordered_json record =
        nlohmann::ordered_json::parse(tests::content_of(directory / "limits.json"), nullptr, false);
    ASSERT_TRUE(record.is_object());
    EXPECT_EQ(record["kind"], "limits");
    EXPECT_EQ(record["contenders"][0]["tags"]["site"], "local");
    EXPECT_EQ(record["contenders"][0]["limits"], printed);
    EXPECT_TRUE(record["provenance"].contains("binary_sha256"));
}

} // namespace
} // namespace carom
