#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/processes/process.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

const std::string reason = "was suspended for some time while it was measured; measure it again";

/// A run that is stopped and continued all the time, by a shell that has its number: where it spends most of
/// its time, and be that milliseconds, some stop comes.
class Suspended : public testing::Test {
  protected:
    /// What the program says, and how it ends.
    static nlohmann::json suspended(std::vector<std::string> words, const std::string& input = "/dev/null") {
        const std::string script = R"("$0" "$@" < "$INPUT" & child=$!
            while kill -STOP $child 2>/dev/null; do
                kill -CONT $child 2>/dev/null; sleep 0.005
            done
            wait $child)";
        words.insert(words.begin(), {"sh", "-c", script, CAROM_PROGRAM});
        ProcessCommand command{.words = words};
        command.environment.push_back("INPUT=" + input);
        return run_undisturbed(command);
    }

    tests::TemporaryDirectory directory;
    const std::string scene =
        directory.write("scene.in", scene_text(tests::random_scene_of_density(3000, 0.6, 100, 9)));
    const std::string record = directory / "record.json";
};

TEST_F(Suspended, WhatIsMeasuredHasNoRecord) {
    const nlohmann::json contenders{{scene, "--threads", "1"},
                                    {scene, "--threads", "1", "--variant", "nine"}};
    const std::string file = directory.write("contenders.json", contenders.dump());
    for (const auto& [words, name] :
         {std::pair{std::vector<std::string>{"turns", file, "--record", record}, "turns of 2 contenders: "},
          {{"bench", scene, "--threads", "1", "--record", record}, "published/scene.in/threads:1: "},
          {{"profile", scene, "--threads", "1", "--record", record}, "scene.in, variant published: "}}) {
        const auto end = suspended(words);
        EXPECT_EQ(end["exit_code"], 1) << end;
        EXPECT_EQ(end["error_end"], "carom: " + (name + reason));
        EXPECT_FALSE(std::filesystem::exists(record));
    }
}

TEST_F(Suspended, TheReportOfGoogleBenchmarkSaysSo) {
    const std::string out = directory / "out.json";
    suspended({"bench", scene, "--threads", "1", "--benchmark_out=" + out, "--benchmark_min_time=0.01"});
    const auto report = nlohmann::json::parse(tests::content_of(out));
    const auto& run = report["benchmarks"][0];
    EXPECT_EQ(run.value("error_occurred", false), true) << report;
    EXPECT_EQ(run.value("error_message", ""), reason);
}

TEST_F(Suspended, OfAProgramOfOthersItIsTold) {
    const std::string plan = directory.write("plan", R"({"processes": [{"command": ["sleep", "0.5"]}]})");
    const auto end = suspended({"processes"}, plan);
    EXPECT_EQ(end["exit_code"], 0) << end;
    EXPECT_EQ(nlohmann::json::parse(end["output_end"].get<std::string>())[0]["suspended"], reason);
}

TEST_F(Suspended, AMachineThatSleptLeavesNoRecord) {
    const std::vector<std::string> asleep{std::string("LD_PRELOAD=") + CAROM_JUMPING_CLOCK,
                                          "CAROM_TEST_SLEEPS=1", "ASAN_OPTIONS=verify_asan_link_order=0"};
    for (const char* verb : {"bench", "profile"}) {
        const auto result = tests::run_carom({verb, scene, "--threads", "1", "--record", record}, asleep);
        EXPECT_EQ(result.exit_code, 1) << verb;
        EXPECT_TRUE(result.error.ends_with(reason + "\n")) << result.error;
        EXPECT_FALSE(std::filesystem::exists(record)) << verb;
    }
}

} // namespace
} // namespace carom
