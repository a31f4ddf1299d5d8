#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harness/counters/cachegrind.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/counters/simulated_scene.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

const std::string header = "desc: I1 cache:         32768 B, 64 B, 8-way associative\n"
                           "desc: D1 cache:         49152 B, 64 B, 12-way associative\n"
                           "desc: LL cache:         8388608 B, 64 B, 16-way associative\n"
                           "cmd: carom run scene.in 1\n";
const std::string events = "events: Bim Ir I1mr ILmr Dr D1mr DLmr Dw D1mw DLmw Bc Bcm Bi\n";
const std::string summary = "summary: 1 2 3 4 5 6 7 8 9 10 11 12 13\n";

TEST(SimulatedOutput, HasTotalsInTheOrderOfItsEventsAndCacheSizes) {
    const auto values =
        parse_cachegrind(header + events + "fl=step.hpp\nfn=step\n12 5 0 0 2 0 0 1 0 0 1 0 0 0\n" + summary);
    for (const auto& [name, value] : {std::pair{"indirect_branch_misses", 1},
                                      {"instructions", 2},
                                      {"l1_read_misses", 6},
                                      {"llc_write_misses", 10},
                                      {"indirect_branches", 13},
                                      {"l1_data_cache_bytes", 49152},
                                      {"llc_bytes", 8388608}}) {
        EXPECT_EQ(values.at(name), value) << name;
    }
    EXPECT_EQ(values.size(), simulated_counts().size() + 3);
}

TEST(SimulatedOutput, SaysWhatIsWrong) {
    for (const auto& [text, said] :
         {std::pair{header + summary, "found '' for Ir"},
          {header + events, "found '' for Ir"},
          {events + summary, "found '' for I1"},
          {header + events + "summary: 1 2\n", "found '' for I1mr"},
          {header + events + "summary: 1 2 x 4 5 6 7 8 9 10 11 12 13\n", "found 'x' for I1mr"},
          {std::string(), "found '' for Ir"}}) {
        try {
            parse_cachegrind(text);
            ADD_FAILURE() << "accepted: " << text;
        } catch (const CounterError& error) {
            EXPECT_EQ(error.what(), "cachegrind's output: " + std::string(said) + ", expected a number");
            EXPECT_NE(error.remedy, "");
        }
    }
}

class SimulatedCounters : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string obstacle = tests::no_simulation(); !obstacle.empty()) {
            GTEST_SKIP() << obstacle;
        }
    }
};

TEST_F(SimulatedCounters, SayWhyTheyHaveNoValue) {
    const tests::TemporaryDirectory directory;
    for (const auto& [script, reason] :
         {std::pair{"echo 'carom: something went wrong' >&2\nexit 3\n",
                    "exit code 3: carom: something went wrong"},
          {"kill -ILL $$\n", "does not know an instruction of this program"}}) {
        const std::string program = directory.write("failing", std::string("#!/bin/sh\n") + script);
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        const auto rows = simulate_counters(tests::simulated_scene(), "published", {}, 1, program);
        EXPECT_EQ(rows.size(), simulated_counts().size());
        for (const CounterValue& row : rows) {
            EXPECT_FALSE(row.value.has_value());
            EXPECT_EQ(row.source, "cachegrind");
            EXPECT_PRED_FORMAT2(testing::IsSubstring, reason, row.reason);
            EXPECT_NE(row.remedy, "");
        }
    }
}

/// What `carom profile` prints of a step under valgrind, in an environment with this setting.
std::string profiled_with(const std::string& setting) {
    const tests::TemporaryDirectory directory;
    const std::string scene = directory.write("scene.in", scene_text(tests::simulated_scene()));
    return tests::run_carom({"profile", scene, "1", "--simulated", "--simulated-steps", "1"}, {setting})
        .output;
}

TEST_F(SimulatedCounters, LeaveNoFilesBehind) {
    const tests::TemporaryDirectory directory;
    const std::string output = profiled_with("TMPDIR=" + (directory / ""));
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "l1_read_misses", output);
    EXPECT_TRUE(directory.empty());
}

TEST(SimulatedCountersWithoutValgrind, SayThatItIsMissing) {
    const tests::TemporaryDirectory directory;
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "because cachegrind: valgrind is not on PATH",
                        profiled_with("PATH=" + (directory / "")));
}

} // namespace
} // namespace carom
