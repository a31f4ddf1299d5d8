#include <string>

#include <gtest/gtest.h>

#include "harness/commands/profile_table.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

using tests::run_carom;

TEST(ProfileCommand, SaysThatThereIsNoSuchCounterWhateverTheMachine) {
    const tests::TemporaryDirectory directory;
    const std::string scene =
        directory.write("scene.in", scene_text(tests::random_scene(150, 50, 1, 6, 2, 161)));
    const auto result = run_carom({"profile", scene, "1", "--counters", "NOPE,PAPI_NOPE,perf::TASK-CLOCK"});
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "not counted: NOPE, PAPI_NOPE\n", result.output);
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "knows no event of that name", result.output);
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "papi_native_avail", result.output);
}

TEST(ProfileCommand, CountsWithoutAPluralOne) {
    const tests::TemporaryDirectory directory;
    const std::string scene = directory.write("scene.in", "1\n10\n1\n1\n0 5 5 1 0\n");
    const auto result = run_carom({"profile", scene, "1"});
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "1 disc, 1 step, variant published, 1 thread, 1 sweep\n",
                        result.output);
}

TEST(ProfilingCost, IsDoubtedWhereItIsNone) {
    EXPECT_EQ(cost_text(1.034), "profiling cost: the profiled run took 1.034 of the bare run's time");
    EXPECT_EQ(cost_text(0.353),
              "profiling cost: the profiled run took 0.353 of the bare run's time; as looking on "
              "saves nothing, something else slowed the bare run");
}

} // namespace
} // namespace carom
