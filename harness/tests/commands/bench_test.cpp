#include <cmath>
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

using tests::ProgramResult;
using tests::refused;
using tests::run_carom;

class BenchCommand : public testing::Test {
  protected:
    ProgramResult bench(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"bench", scene, "--threads", "1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_carom(arguments);
    }

    tests::TemporaryDirectory directory;
    std::string scene = directory.write("scene.in", scene_text(tests::random_scene(300, 80, 1, 20, 2, 7)));
};

TEST_F(BenchCommand, RatesAreOfTheRunsWhoseTimesStandBesideThem) {
    const ProgramResult result = bench({"--benchmark_min_time=0.05", "--benchmark_format=json"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const auto json = nlohmann::json::parse(result.output);
    const auto& row = json["benchmarks"][0];
    EXPECT_GT(row["iterations"], 1) << "one run is its own average: this test shows nothing";
    ASSERT_EQ(row["time_unit"], "ms");
    const double expected = 300 * 20 / (1e-3 * row["real_time"].get<double>());
    EXPECT_NEAR(row["disc_steps_per_second"].get<double>() / expected, 1, 1e-9);
}

TEST_F(BenchCommand, ExplainsWhereGoogleBenchmarkWarnsOfItsOwnBuild) {
    const ProgramResult result = bench({"--repetitions", "1"});
    EXPECT_EQ(result.error.find("Library was built as DEBUG"), std::string::npos) << result.error;
    const auto json = nlohmann::json::parse(bench({"--repetitions", "1", "--benchmark_format=json"}).output);
    EXPECT_EQ(result.notes.find("Google Benchmark was built as DEBUG") != std::string::npos,
              json["context"]["library_build_type"] == "debug")
        << result.notes;
}

TEST_F(BenchCommand, ReadsTheSceneFromStandardInput) {
    const std::string record = directory / "record";
    const ProgramResult result =
        run_carom({"bench", "-", "--threads", "1", "--record", record}, {}, "", scene);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const auto found = nlohmann::json::parse(tests::content_of(record))["contenders"][0];
    EXPECT_EQ(found["scene"]["name"], "standard input");
    EXPECT_EQ(found["scene"]["particles"], 300);
}

} // namespace
} // namespace carom
