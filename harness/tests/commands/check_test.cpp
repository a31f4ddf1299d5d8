#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/measure/measure.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::ProgramResult;
using tests::refused;
using tests::run_carom;
using tests::TemporaryDirectory;

class CheckCommand : public testing::Test {
  protected:
    TemporaryDirectory directory;
};

TEST_F(CheckCommand, PassesARightRunOnOneLine) {
    const Scene busy = tests::random_scene(150, 50, 1, 6, 2, 171);
    const std::string scene = directory.write("scene.in", scene_text(busy));
    for (const char* threads : {"1", "2"}) {
        const ProgramResult result = run_carom({"check", scene, threads, "--variant", "published"});
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.error, "");
        EXPECT_TRUE(
            result.output.starts_with("passed: " + scene + ", variant published, 6 steps of 150 discs"))
            << result.output;
        EXPECT_PRED_FORMAT2(testing::IsSubstring, state_hash(tests::simulate<Policies{}>(busy).discs),
                            result.output);
    }
}

TEST_F(CheckCommand, PassesEveryAwkwardScene) {
    for (const auto& [name, scene] : tests::all_scenes()) {
        const std::string path = directory.write("scene.in", scene_text(scene));
        const ProgramResult result = run_carom({"check", path, "2", "--variant", "row-resolve_dynamic"});
        EXPECT_EQ(result.exit_code, 0) << name << ": " << result.error;
    }
}

TEST_F(CheckCommand, NamesTheFirstViolation) {
    const std::string jammed = directory.write("jammed.in", "2\n4\n1\n9\n0 1 2 0 0\n1 2 2 1 0\n");
    for (const char* variant : {"published", "row", "track", "repeat", "once"}) {
        const ProgramResult result =
            run_carom({"check", jammed, "1", "--variant", variant, "--sweep-limit", "30"});
        EXPECT_TRUE(refused(result, 2,
                            {jammed, std::string("variant ") + variant,
                             "step 1: the resolve did not end within 30 sweeps: disc"}));
    }
}

TEST_F(CheckCommand, GivesItsVerdictAsJson) {
    const Scene busy = tests::random_scene(150, 50, 1, 6, 2, 171);
    const std::string scene = directory.write("scene.in", scene_text(busy));
    const ProgramResult passed = run_carom({"check", scene, "2", "--variant", "published", "--json"});
    EXPECT_EQ(passed.exit_code, 0);
    EXPECT_EQ(passed.error, "");
    const auto json = nlohmann::json::parse(passed.output);
    EXPECT_EQ(json["verdict"], "passed");
    EXPECT_TRUE(json["reason"].is_null());
    EXPECT_EQ(json["scene"], scene);
    EXPECT_EQ(json["variant"], "published");
    EXPECT_EQ(json["threads"], 2);
    EXPECT_EQ(json["particles"], 150);
    EXPECT_EQ(json["steps"], 6);
    EXPECT_EQ(json["state_hash"], state_hash(tests::simulate<Policies{}>(busy).discs));
}

TEST_F(CheckCommand, SaysWhatItLookedAt) {
    const std::string scene = directory.write("scene.in", scene_text(tests::cradle()));
    const auto scope_of = [&](const char* variant) {
        const ProgramResult result = run_carom({"check", scene, "1", "--variant", variant, "--json"});
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return nlohmann::json::parse(result.output)["scope"];
    };
    EXPECT_EQ(scope_of("event_driven"), "every-collision");
    EXPECT_EQ(scope_of("at_contact-float"), "every-collision");
    EXPECT_EQ(scope_of("row"), "every-step");
}

TEST_F(CheckCommand, GivesTheVerdictOfAFailureAsJsonAndInALine) {
    const std::string jammed = directory.write("jammed.in", "2\n4\n1\n9\n0 1 2 0 0\n1 2 2 1 0\n");
    const ProgramResult failed = run_carom({"check", jammed, "1", "--sweep-limit", "30", "--json"});
    EXPECT_EQ(failed.exit_code, 2);
    const auto json = nlohmann::json::parse(failed.output);
    EXPECT_EQ(json["verdict"], "failed");
    EXPECT_TRUE(json["state_hash"].is_null());
    const std::string reason = json["reason"];
    EXPECT_TRUE(reason.starts_with("step 1: the resolve did not end within 30 sweeps"));
    EXPECT_EQ(failed.error, "carom: " + jammed + ", variant published, " + reason + "\n");
}

TEST_F(CheckCommand, ReadsTheSceneFromStandardInput) {
    const std::string scene = directory.write("scene.in", scene_text(tests::corner()));
    const ProgramResult result = run_carom({"check", "-"}, {}, "", scene);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_TRUE(result.output.starts_with("passed: standard input, variant published, ")) << result.output;
}

TEST_F(CheckCommand, NamesTheSubstepOfTheViolation) {
    // Two substeps of a half bring the disc to x = r.
    const std::string wedged = directory.write("wedged.in", "1\n2\n1\n9\n0 0.5 1 0.5 0\n");
    EXPECT_TRUE(refused(run_carom({"check", wedged, "--substeps", "2", "--sweep-limit", "30"}), 2,
                        {"step 1 substep 2 of 2: "}));
}

TEST_F(CheckCommand, RefusesAFloatVariantWhereItsRangeEnds) {
    for (const char* text :
         {"1\n1e16\n1\n1\n0 5 5 1 0\n", "1\n1\n1e-16\n1\n0 0.5 0.5 1 0\n", "1\n10\n1\n1\n0 5 5 1e-16 0\n",
          "1\n10\n1\n1\n0 5 5 1e16 0\n", "1\n1e10\n1e9\n1\n0 5e9 5e9 1e9 0\n"}) {
        const std::string beyond = directory.write("beyond.in", text);
        EXPECT_TRUE(refused(run_carom({"check", beyond, "1", "--variant", "float"}), 1,
                            {"--variant float: computes in float", "expected a variant in double"}))
            << text;
        EXPECT_EQ(run_carom({"check", beyond, "1", "--variant", "published"}).exit_code, 0) << text;
    }
    const std::string at_rest = directory.write("at_rest.in", "1\n10\n1\n1\n0 5 5 0 0\n");
    EXPECT_EQ(run_carom({"check", at_rest, "1", "--variant", "float"}).exit_code, 0);
}

} // namespace
} // namespace carom
