#include <chrono>
#include <ctime>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

bool is_today(const std::string& text) {
    std::tm parts{};
    strptime(text.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return std::abs(std::difftime(timegm(&parts), std::time(nullptr))) < 86'400;
}

/// While the time of day jumps by days, no duration is longer than the command took by this process's clock.
TEST(JumpingClock, ChangesNoDuration) {
    const tests::TemporaryDirectory directory;
    const std::string scene =
        directory.write("scene.in", scene_text(tests::random_scene(300, 80, 1, 20, 2, 7)));
    const std::string file = directory / "record.json";
    for (const auto& [verb, fewest] : {std::pair{"bench", 4}, {"profile", 2 + 8 + 8}}) {
        const auto began = std::chrono::steady_clock::now();
        const auto result = tests::run_carom(
            {verb, scene, "--threads", "1", "--record", file},
            {std::string("LD_PRELOAD=") + CAROM_JUMPING_CLOCK, "ASAN_OPTIONS=verify_asan_link_order=0"});
        const double elapsed =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        ASSERT_EQ(result.exit_code, 0) << result.error;
        const auto record = nlohmann::json::parse(tests::content_of(file));
        EXPECT_FALSE(is_today(record["recorded_at"])) << "the clock did not jump: this test shows nothing";
        int durations = 0;
        const auto flat = record["contenders"][0].flatten();
        for (const auto& [path, value] : flat.items()) {
            if (path.ends_with("_seconds")) {
                EXPECT_GE(value, 0) << path;
                EXPECT_LT(value, elapsed) << path;
                ++durations;
            }
        }
        EXPECT_GE(durations, fewest) << verb;
    }
}

} // namespace
} // namespace carom
