#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/measure/chipmunk.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

using Json = nlohmann::json;

/// Two discs that meet in the middle of the box after a while, and one that meets a wall.
const Scene meeting{
    .side = 100, .radius = 5, .steps = 20, .discs = {{20, 50, 2, 0}, {80, 50, -2, 0}, {50, 20, 0, -1}}};

/// Skips where the program was built without Chipmunk, having seen that it says so.
class Outside : public testing::Test {
  protected:
    void SetUp() override {
        try {
            run_chipmunk(meeting, 1, 10);
        } catch (const NotBuiltIn& absent) {
            const auto result = tests::run_carom({"outside", scene});
            EXPECT_TRUE(tests::refused(result, 3, {"built without Chipmunk", "-DCAROM_CHIPMUNK=ON"}));
            GTEST_SKIP() << absent.what();
        }
    }

    tests::TemporaryDirectory directory;
    std::string scene = directory.write("scene.in", scene_text(meeting));
};

TEST_F(Outside, DiscsBounceOffEachOtherAndOffWalls) {
    const ChipmunkRun run = run_chipmunk(meeting, 8, 10);
    ASSERT_EQ(run.discs.size(), 3U);
    EXPECT_NEAR(run.discs[0].vx, -2, 1e-9);
    EXPECT_NEAR(run.discs[1].vx, 2, 1e-9);
    EXPECT_NEAR(run.discs[2].vy, 1, 1e-9);
    EXPECT_NEAR(run.discs[0].x + run.discs[1].x, 100, 1e-9);
    EXPECT_NEAR(run.discs[2].y, 10, 1); // 15 down, 5 up again
    EXPECT_GT(run.steps_seconds, 0);
}

TEST_F(Outside, RecordsTimeAndDriftOfEnergy) {
    const std::string record = directory / "outside.json";
    const auto result = tests::run_carom(
        {"outside", scene, "--substeps", "4", "--iterations", "7", "--record", record, "--tag", "x=4"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const Json found = Json::parse(tests::content_of(record), nullptr, false);
    ASSERT_TRUE(found.is_object());
    EXPECT_EQ(found["kind"], "outside");
    EXPECT_EQ(found["engine"]["name"], "Chipmunk");
    EXPECT_EQ(found["engine"]["iterations"], 7);
    EXPECT_EQ(found["axes"]["substeps"], 4);
    EXPECT_EQ(found["tags"]["x"], 4);
    EXPECT_EQ(found["scene"]["particles"], 3);
    EXPECT_LT(std::abs(found["errors"]["energy_drift"].get<double>()), 1e-6);
    EXPECT_EQ(found["errors"]["discs_outside"], 0);
}

} // namespace
} // namespace carom
