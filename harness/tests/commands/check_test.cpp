#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/measure/measure.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/name.hpp"
#include "variants/table.hpp"

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

TEST_F(CheckCommand, RunsTheVariantsOfAnotherBuild) {
    const std::string scene =
        directory.write("scene.in", scene_text(tests::random_scene(150, 50, 1, 6, 2, 171)));
    const std::string library = CAROM_VARIANTS;
    const ProgramResult own = run_carom({"check", scene});
    const ProgramResult other = run_carom({"check", scene, "--variants-of", library});
    EXPECT_EQ(other.exit_code, 0) << other.error;
    EXPECT_EQ(other.output, own.output) << "the same source ends in the same bits";

    const std::string record = directory.path() / "record.json";
    ASSERT_EQ(run_carom({"bench", scene, "--variants-of", library, "--record", record}).exit_code, 0);
    const auto told = nlohmann::json::parse(tests::content_of(record));
    const auto& origin = told["contenders"][0]["provenance"];
    EXPECT_EQ(origin["compiler"], told["provenance"]["compiler"]);
    EXPECT_NE(origin["binary_sha256"], told["provenance"]["binary_sha256"]);
}

TEST_F(CheckCommand, RefusesALibraryThatHasNoVariants) {
    const std::string scene =
        directory.write("scene.in", scene_text(tests::random_scene(20, 50, 1, 1, 2, 171)));
    const std::string none = directory.write("none.so", "no library");
    EXPECT_TRUE(
        refused(run_carom({"check", scene, "--variants-of", none}), 1, {"carom-variants.so of a build"}));
    EXPECT_TRUE(refused(run_carom({"check", scene, "--variants-of", CAROM_JUMPING_CLOCK}), 1,
                        {"found no variants, expected carom-variants.so of a build"}));
}

TEST_F(CheckCommand, PassesARightRunOnOneLineOrAsJson) {
    const Scene busy = tests::random_scene(150, 50, 1, 6, 2, 171);
    const std::string scene = directory.write("scene.in", scene_text(busy));
    const std::string hash = state_hash(tests::simulate<Policies{}>(busy).discs);
    for (const std::string& from : {scene, std::string("-")}) {
        const ProgramResult result = run_carom({"check", from, "2", "--variant", "published"}, {}, "", scene);
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.error, "");
        EXPECT_TRUE(result.output.starts_with("passed: " + (from == "-" ? "standard input" : scene) +
                                              ", variant published, 6 steps of 150 discs"))
            << result.output;
        EXPECT_PRED_FORMAT2(testing::IsSubstring, hash, result.output);
    }
    const auto json =
        nlohmann::json::parse(run_carom({"check", scene, "1", "--variant", "published", "--json"}).output);
    const nlohmann::json expected{
        {"verdict", "passed"}, {"reason", nullptr}, {"scene", scene}, {"variant", "published"},
        {"threads", 1},        {"particles", 150},  {"steps", 6},     {"state_hash", hash}};
    for (const auto& [key, value] : expected.items()) {
        EXPECT_EQ(json[key], value) << key;
    }
}

TEST_F(CheckCommand, PassesEveryAwkwardScene) {
    for (const auto& [name, scene] : tests::all_scenes()) {
        const std::string path = directory.write("scene.in", scene_text(scene));
        const ProgramResult result = run_carom({"check", path, "2", "--variant", "row-resolve_dynamic"});
        EXPECT_EQ(result.exit_code, 0) << name << ": " << result.error;
    }
}

TEST_F(CheckCommand, NamesTheFirstViolationAsJsonAndInALine) {
    const std::string jammed = directory.write("jammed.in", "2\n4\n1\n9\n0 1 2 0 0\n1 2 2 1 0\n");
    for (const std::string variant : {"published", "row", "track", "repeat", "once"}) {
        const ProgramResult failed =
            run_carom({"check", jammed, "1", "--variant", variant, "--sweep-limit", "30", "--json"});
        EXPECT_EQ(failed.exit_code, 2);
        const auto json = nlohmann::json::parse(failed.output);
        EXPECT_EQ(json["verdict"], "failed");
        EXPECT_TRUE(json["state_hash"].is_null());
        const std::string reason = json["reason"];
        EXPECT_TRUE(reason.starts_with("step 1: the resolve did not end within 30 sweeps: disc")) << reason;
        EXPECT_EQ(failed.error, "carom: " + jammed + ", variant " + variant + ", " + reason + "\n");
    }
}

TEST_F(CheckCommand, SaysWhatItLookedAt) {
    const std::string scene = directory.write("scene.in", scene_text(tests::cradle()));
    const auto scope_of = [&](const char* variant) {
        const ProgramResult result = run_carom({"check", scene, "1", "--variant", variant, "--json"});
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return nlohmann::json::parse(result.output)["scope"];
    };
    EXPECT_EQ(scope_of("event_driven"), "every-collision");
    EXPECT_EQ(scope_of(name_of(at_contact(ladder.back())).view().data()), "every-collision");
    EXPECT_EQ(scope_of("row"), "every-step");
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
