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

using tests::content_of;
using tests::run_carom;

TEST(ReferenceCommand, WritesToAFileWhatItWouldPrint) {
    const tests::TemporaryDirectory directory;
    const std::string scene = directory.write("scene.in", scene_text(tests::corner()));
    const std::string output = directory / "state";
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--json"}}) {
        std::vector<std::string> arguments{"reference", scene, "--time", "1.5"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const std::string printed = run_carom(arguments).output;
        EXPECT_FALSE(printed.empty());
        arguments.insert(arguments.end(), {"--output", output});
        const auto result = run_carom(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        EXPECT_EQ(result.output, "");
        EXPECT_EQ(content_of(output), printed);
    }
}

TEST(ReferenceCommand, ReadsTheSceneFromStandardInput) {
    const tests::TemporaryDirectory directory;
    const std::string scene = directory.write("scene.in", scene_text(tests::corner()));
    EXPECT_EQ(run_carom({"reference", "-", "--time", "1"}, {}, "", scene).output,
              run_carom({"reference", scene, "--time", "1"}).output);
}

TEST(ReferenceCommand, PrintsTheSameWhenItsCollisionsAreChecked) {
    const tests::TemporaryDirectory directory;
    const std::string scene =
        directory.write("scene.in", scene_text(tests::random_scene(150, 50, 1, 6, 2, 7)));
    const auto checked = run_carom({"reference", scene, "--time", "3", "--check"});
    EXPECT_EQ(checked.exit_code, 0) << checked.error;
    EXPECT_EQ(checked.output, run_carom({"reference", scene, "--time", "3"}).output);
    const auto json =
        nlohmann::json::parse(run_carom({"reference", scene, "--time", "3", "--check", "--json"}).output);
    EXPECT_EQ(json["check"], "passed");
    EXPECT_GT(json["pair_collisions"], 10);
}

/// Enough discs for tiles on two threads.
TEST(ReferenceCommand, PrintsTheSameOnAnyNumberOfThreadsAndPassesItsCheck) {
    const tests::TemporaryDirectory directory;
    const std::string scene = directory.write("scene.in", scene_text(tests::lattice_scene(130, 0.5, 3)));
    for (const std::string format : {"--json", "--output=-"}) {
        const auto alone = run_carom({"reference", scene, "--time", "0.3", "--check", format});
        const auto shared =
            run_carom({"reference", scene, "--time", "0.3", "--check", format, "--threads", "2"});
        EXPECT_EQ(shared.exit_code, 0) << shared.error;
        EXPECT_EQ(shared.output, alone.output);
    }
}

} // namespace
} // namespace carom
