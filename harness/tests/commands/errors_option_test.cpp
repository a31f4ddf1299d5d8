#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/accuracy/error_measures.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

using tests::content_of;
using tests::ProgramResult;
using tests::run_carom;

const std::vector<std::string> fields{
    "energy_drift",       "discs_outside",    "unresolved_pairs",     "momentum_drift",
    "penetration_worst",  "penetration_mean", "collision_rate",       "pressure",
    "pressure_reason",    "trajectory",       "time_to_tenth_radius", "collision_rate_reference",
    "pressure_reference", "speed_distance",   "reference_reason"};

class ErrorsOption : public testing::Test {
  protected:
    nlohmann::json record_of(const std::vector<std::string>& more) {
        std::vector<std::string> arguments{
            "bench", path,       "--threads",         "2", "--substeps", "2", "--repetitions",
            "2",     "--record", directory / "record"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run_carom(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return nlohmann::json::parse(content_of(directory / "record"))["contenders"][0];
    }

    tests::TemporaryDirectory directory;
    const Scene scene = tests::random_scene(100, 50, 1, 6, 1, 171);
    const std::string path = directory.write("scene.in", scene_text(scene));
};

TEST_F(ErrorsOption, FillsTheRecordOfABench) {
    const auto record = record_of({"--errors"});
    const auto expected =
        error_measures_json(measure_errors(scene, *find_variant("published"), {.threads = 2, .substeps = 2}));
    EXPECT_EQ(record["errors"], nlohmann::json(expected));
    EXPECT_EQ(record["errors"].size(), fields.size());
    EXPECT_EQ(record["repetitions"].size(), 2u);
    EXPECT_EQ(record["check"]["verdict"], "passed");
}

TEST_F(ErrorsOption, LeavesARecordWithoutItAsItWas) {
    const auto errors = record_of({})["errors"];
    EXPECT_EQ(errors.size(), 3u);
    EXPECT_TRUE(errors.contains("energy_drift"));
    EXPECT_FALSE(errors.contains("trajectory"));
}

TEST_F(ErrorsOption, ShowsInTheSummaryOfARun) {
    const auto summary = nlohmann::json::parse(
        run_carom({"run", path, "2", "--variant", "published", "--substeps", "2", "--errors", "--json"})
            .output);
    EXPECT_EQ(summary["errors"], record_of({"--errors"})["errors"]);
    EXPECT_FALSE(nlohmann::json::parse(run_carom({"run", path, "2", "--json"}).output).contains("errors"));
    const std::string text = run_carom({"run", path, "2", "--errors"}).output;
    for (const char* part : {"worst penetration", "pressure", "of the reference", "distance after      6"}) {
        EXPECT_PRED_FORMAT2(testing::IsSubstring, part, text);
    }
}

TEST_F(ErrorsOption, FieldsAreThoseOfTheSchema) {
    const auto schema = nlohmann::json::parse(content_of(CAROM_SCHEMA));
    const auto& properties = schema["$defs"]["errors"]["properties"];
    const nlohmann::json errors = record_of({"--errors"})["errors"];
    for (const auto& [field, value] : errors.items()) {
        EXPECT_TRUE(properties.contains(field)) << field;
    }
    EXPECT_EQ(properties.size(), fields.size());
}

} // namespace
} // namespace carom
