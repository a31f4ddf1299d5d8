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

TEST_F(ErrorsOption, FillsTheRecordOfABenchWithAllThatTheSchemaKnows) {
    const auto record = record_of({"--errors"});
    const auto expected =
        error_measures_json(measure_errors(scene, *find_variant("published"), {.threads = 2, .substeps = 2}));
    EXPECT_EQ(record["errors"], nlohmann::json(expected));
    EXPECT_EQ(record["repetitions"].size(), 2u);
    EXPECT_EQ(record["check"]["verdict"], "passed");
    const auto schema = nlohmann::json::parse(content_of(CAROM_SCHEMA));
    const auto& properties = schema["$defs"]["errors"]["properties"];
    for (const auto& [field, value] : record["errors"].items()) {
        EXPECT_TRUE(properties.contains(field)) << field;
    }
    EXPECT_EQ(record["errors"].size(), properties.size());
    const auto without = record_of({})["errors"];
    EXPECT_EQ(without.size(), 3u);
    EXPECT_TRUE(without.contains("energy_drift"));
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

} // namespace
} // namespace carom
