#include <string>
#include <vector>

#include <gtest/gtest.h>

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
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--json"}, {"--extended"}}) {
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

} // namespace
} // namespace carom
