#include <chrono>
#include <ctime>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

using tests::run_carom;

/// What a command says of its time while the time of day jumps by days, and how long it took by this
/// process's clock.
class JumpingClock : public testing::Test {
  protected:
    nlohmann::json record_of(const std::string& verb) {
        const std::string record = directory / "record.json";
        const auto began = std::chrono::steady_clock::now();
        const auto result = run_carom(
            {verb, scene, "--threads", "1", "--record", record},
            {std::string("LD_PRELOAD=") + CAROM_JUMPING_CLOCK, "ASAN_OPTIONS=verify_asan_link_order=0"});
        elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        EXPECT_EQ(result.exit_code, 0) << result.error;
        auto found = nlohmann::json::parse(tests::content_of(record));
        found.update(nlohmann::json(found["contenders"][0]));
        return found;
    }

    tests::TemporaryDirectory directory;
    std::string scene = directory.write("scene.in", scene_text(tests::random_scene(300, 80, 1, 20, 2, 7)));
    double elapsed = 0;
};

bool is_today(const std::string& text) {
    std::tm parts{};
    strptime(text.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return std::abs(std::difftime(timegm(&parts), std::time(nullptr))) < 86'400;
}

TEST_F(JumpingClock, ChangesNoDuration) {
    const auto record = record_of("bench");
    EXPECT_FALSE(is_today(record["recorded_at"])) << "the clock did not jump: this test shows nothing";
    for (const auto& repetition : record["repetitions"]) {
        EXPECT_GT(repetition["steps_seconds"], 0);
        EXPECT_LT(repetition["steps_seconds"], elapsed);
        EXPECT_GE(repetition["cpu_seconds"], 0);
        EXPECT_LT(repetition["cpu_seconds"], elapsed);
    }
    EXPECT_GT(record["process_seconds"], 0);
    EXPECT_LT(record["process_seconds"], elapsed);
    EXPECT_GE(record["parse_seconds"], 0);
    EXPECT_LT(record["parse_seconds"], elapsed);
}

TEST_F(JumpingClock, ChangesNoPhase) {
    const auto record = record_of("profile");
    EXPECT_FALSE(is_today(record["recorded_at"])) << "the clock did not jump: this test shows nothing";
    double phases = 0;
    for (const auto& phase : record["profile"]["phases"]) {
        EXPECT_GE(phase["wall_seconds"], 0);
        phases += phase["wall_seconds"].get<double>();
    }
    EXPECT_GT(phases, 0);
    EXPECT_LT(phases, elapsed);
    for (const auto& thread : record["profile"]["threads"]) {
        EXPECT_GE(thread["busy_seconds"], 0);
        EXPECT_LT(thread["busy_seconds"], elapsed);
    }
}

} // namespace
} // namespace carom
