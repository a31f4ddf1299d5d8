#include <algorithm>
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

using tests::refused;
using tests::run_carom;

class ErrorBelow : public testing::Test {
  protected:
    ErrorBelow() {
        run_carom({"generate", "400", "60", "1", "6", "0.1", "0.4", "--seed", "31", "--placement", "random",
                   "--isotropic", "--output", apart});
    }

    tests::ProgramResult run(const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"run", apart};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_carom(arguments);
    }

    tests::TemporaryDirectory directory;
    const std::string apart = directory / "apart.in";
};

TEST_F(ErrorBelow, SaysInTwoLinesWhatItChoseAndRunsIt) {
    const auto result = run({"--error-below", "0.01"});
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.output.find("chosen for an error below 0.01: "), 0);
    const auto second = result.output.substr(result.output.find('\n') + 1);
    EXPECT_EQ(second.find("from "), 0) << second;
    EXPECT_EQ(second.substr(second.find('\n') + 1).find(apart + ": 400 discs"), 0) << second;
}

TEST_F(ErrorBelow, DeliversWhatItExpects) {
    for (const std::string measure : {"path", "collision_rate", "pressure"}) {
        const auto result = run({"--error-below", "0.02", "--measure", measure, "--json", "--errors"});
        ASSERT_EQ(result.exit_code, 0) << result.error;
        const auto json = nlohmann::json::parse(result.output);
        const auto& choice = json["choice"];
        EXPECT_EQ(choice["error_below"], 0.02);
        EXPECT_EQ(choice["measure"], measure);
        EXPECT_EQ(choice["variant"], json["variant"]);
        EXPECT_EQ(choice["substeps"], json["substeps"]);
        EXPECT_LE(choice["largest_error"], 0.02);
        EXPECT_TRUE(choice["trial"]["whole_scene"]);
        const auto& tried = choice["trial"]["tried"];
        EXPECT_EQ(tried[0]["variant"], "event_driven");
        EXPECT_TRUE(std::ranges::any_of(tried, [&](const auto& one) {
            return one["variant"] == choice["variant"] && one["error"] == choice["error"];
        }));
        if (measure == "path") {
            const double delivered = json["errors"]["trajectory"][0]["rms_distance"];
            EXPECT_NEAR(delivered, choice["error"].get<double>(), 1e-12) << "the trial was the beginning";
        }
    }
}

TEST_F(ErrorBelow, SaysWhatIsBestWhereNothingReachesTheBound) {
    EXPECT_TRUE(refused(run({"--error-below", "1e-30"}), 1,
                        {"--error-below 1e-30", "found no method with so small an error", "the best is"}));
}

} // namespace
} // namespace carom
