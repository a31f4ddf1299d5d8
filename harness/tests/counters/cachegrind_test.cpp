#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/counters/cachegrind.hpp"
#include "harness/counters/cachegrind_output.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/counters/simulated_scene.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

/// The reason that all counts have for having no value.
std::string only_reason(const std::vector<CounterValue>& rows) {
    EXPECT_EQ(rows.size(), simulated_counts().size());
    for (const CounterValue& row : rows) {
        EXPECT_FALSE(row.value.has_value());
        EXPECT_EQ(row.source, "cachegrind");
        EXPECT_EQ(row.reason, rows.front().reason);
        EXPECT_NE(row.remedy, "");
    }
    return rows.front().reason;
}

class SimulatedCounters : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string obstacle = tests::no_simulation(); !obstacle.empty()) {
            GTEST_SKIP() << obstacle;
        }
    }
};

TEST_F(SimulatedCounters, AProgramThatFailsIsTheReason) {
    const tests::TemporaryDirectory directory;
    const std::string program =
        directory.write("failing", "#!/bin/sh\necho 'carom: something went wrong' >&2\nexit 3\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const std::string reason =
        only_reason(simulate_counters(tests::simulated_scene(), "published", {}, 1, program));
    EXPECT_NE(reason.find("exit code 3: carom: something went wrong"), std::string::npos) << reason;
}

TEST_F(SimulatedCounters, AnInstructionThatValgrindDoesNotKnowIsTheReason) {
    const tests::TemporaryDirectory directory;
    const std::string program = directory.write("dying", "#!/bin/sh\nkill -ILL $$\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const std::string reason =
        only_reason(simulate_counters(tests::simulated_scene(), "published", {}, 1, program));
    EXPECT_NE(reason.find("does not know an instruction of this program"), std::string::npos) << reason;
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
