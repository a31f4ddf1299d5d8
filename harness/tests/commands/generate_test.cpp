#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/scenes/generate.hpp"
#include "harness/scenes/hard_cases.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

using tests::content_of;
using tests::ProgramResult;
using tests::refused;
using tests::run_carom;
using tests::TemporaryDirectory;

std::string expected_text(std::uint64_t seed) {
    return scene_text(generate({.count = 40,
                                .side = 100.5,
                                .radius = 1.5,
                                .steps = 7,
                                .least_velocity = -2,
                                .largest_velocity = 5,
                                .seed = seed}));
}

const std::vector<std::string> arguments{"generate", "40", "100.5", "1.5", "7", "-2", "5"};

ProgramResult generate_with(const std::vector<std::string>& more) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), more.begin(), more.end());
    return run_carom(all);
}

/// The arguments with one replaced.
ProgramResult generate_with(std::size_t position, const std::string& value) {
    std::vector<std::string> all = arguments;
    all[position] = value;
    return run_carom(all);
}

TEST(GenerateCommand, WritesTheSceneToStandardOutput) {
    const ProgramResult result = run_carom(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.error, "");
    EXPECT_EQ(result.output, expected_text(1));
}

TEST(GenerateCommand, TakesASeed) {
    EXPECT_EQ(generate_with({"--seed", "12"}).output, expected_text(12));
    EXPECT_EQ(generate_with({"--seed", "18446744073709551615"}).output, expected_text(UINT64_MAX));
}

TEST(GenerateCommand, WritesAFileThatRunReads) {
    const TemporaryDirectory directory;
    const std::string path = directory / "scene.in";
    const ProgramResult result = generate_with({"--output", path});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(content_of(path), expected_text(1));
    EXPECT_EQ(run_carom({"check", path}).exit_code, 0);
}

TEST(GenerateCommand, WritesToStandardOutputIfToldSo) {
    EXPECT_EQ(generate_with({"--output", "-"}).output, expected_text(1));
}

TEST(GenerateCommand, RefusesWhatNoSceneCanHave) {
    EXPECT_TRUE(refused(generate_with(1, "-1"), 1, {"N"}));
    EXPECT_TRUE(refused(generate_with(1, "1.5"), 1, {"N"}));
    EXPECT_TRUE(refused(generate_with(1, "100000001"), 1, {"N"}));
    EXPECT_TRUE(refused(generate_with(2, "2.9"), 1, {"L", "2.9", "2r = 3"}));
    EXPECT_TRUE(refused(generate_with(2, "nan"), 1, {"L"}));
    EXPECT_TRUE(refused(generate_with(2, "inf"), 1, {"L"}));
    EXPECT_TRUE(refused(generate_with(3, "0"), 1, {"R", "found 0"}));
    EXPECT_TRUE(refused(generate_with(3, "-1"), 1, {"R"}));
    EXPECT_TRUE(refused(generate_with(3, "nan"), 1, {"R"}));
    EXPECT_TRUE(refused(generate_with(4, "-1"), 1, {"STEPS"}));
    EXPECT_TRUE(refused(generate_with(4, "ten"), 1, {"STEPS"}));
    EXPECT_TRUE(refused(generate_with(5, "6"), 1, {"VMAX", "VMIN = 6"}));
    EXPECT_TRUE(refused(generate_with(5, "nan"), 1, {"VM"}));
    EXPECT_TRUE(refused(generate_with(6, "nan"), 1, {"VMAX"}));
    EXPECT_TRUE(refused(generate_with(6, "1e61"), 1, {"VMAX"}));
    EXPECT_TRUE(refused(generate_with({"--seed", "-1"}), 1, {"--seed"}));
    EXPECT_TRUE(refused(run_carom({"generate", "40", "100"}), 1, {"found no R"}));
}

TEST(GenerateCommand, LeavesNoFileWhereItIsRefused) {
    const TemporaryDirectory directory;
    std::vector<std::string> all = arguments;
    all[3] = std::string("0");
    all.insert(all.end(), {"--output", directory / "scene.in"});
    EXPECT_TRUE(refused(run_carom(all), 1, {"R"}));
    EXPECT_TRUE(directory.empty());
}

TEST(GenerateCommand, PlacesDiscsApartAndSaysTheAreaFraction) {
    for (const char* placement : {"random", "lattice"}) {
        const ProgramResult result =
            run_carom({"generate", "200", "50", "1", "7", "0", "2", "--placement", placement, "--isotropic"});
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.error, "carom: area fraction 0.251327, no disc overlaps another\n");
        EXPECT_EQ(result.output,
                  scene_text(generate({.count = 200,
                                       .side = 50,
                                       .radius = 1,
                                       .steps = 7,
                                       .least_velocity = 0,
                                       .largest_velocity = 2,
                                       .placement = placement == std::string("random") ? Placement::random
                                                                                       : Placement::lattice,
                                       .isotropic = true})));
    }
}

TEST(GenerateCommand, RefusesPlacementsWithoutRoom) {
    const TemporaryDirectory directory;
    for (const char* placement : {"random", "lattice"}) {
        EXPECT_TRUE(refused(run_carom({"generate", "800", "50", "1", "7", "0", "2", "--placement", placement,
                                       "--output", directory / "scene.in"}),
                            1, {"--placement", placement, "area fraction", "expected"}));
    }
    EXPECT_TRUE(directory.empty());
    EXPECT_TRUE(refused(generate_with({"--placement", "square"}), 1, {"--placement", "square"}));
    EXPECT_TRUE(refused(generate_with({"--isotropic"}), 1, {"VMIN", "found -2", "at least 0"}));
}

TEST(GenerateCommand, WritesAHardCase) {
    for (const HardCase& one : hard_cases()) {
        const ProgramResult result = run_carom({"generate", "--case", std::string(one.name)});
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.error, "");
        EXPECT_EQ(result.output, scene_text(one.scene())) << one.name;
        EXPECT_EQ(scene_text(parse_scene(result.output, "")), result.output) << one.name;
    }
}

TEST(GenerateCommand, ListsTheHardCases) {
    const std::string lines = run_carom({"generate", "--cases"}).output;
    const auto json = nlohmann::json::parse(run_carom({"generate", "--cases", "--json"}).output);
    ASSERT_EQ(json.size(), hard_cases().size());
    for (std::size_t i = 0; i < json.size(); ++i) {
        EXPECT_EQ(json[i]["name"], hard_cases()[i].name);
        EXPECT_EQ(json[i]["description"], hard_cases()[i].description);
        EXPECT_PRED_FORMAT2(testing::IsSubstring, json[i]["description"].get<std::string>(), lines);
    }
}

TEST(GenerateCommand, RefusesAMixtureOfRandomSceneAndHardCase) {
    EXPECT_TRUE(refused(run_carom({"generate", "--case", "cradel"}), 1, {"--case", "cradel", "--cases"}));
    EXPECT_TRUE(refused(generate_with({"--case", "cradle"}), 1, {"--case"}));
    EXPECT_TRUE(refused(run_carom({"generate", "--case", "cradle", "--seed", "3"}), 1, {"--seed"}));
    EXPECT_TRUE(refused(run_carom({"generate", "--case", "cradle", "--cases"}), 1, {"--cases"}));
    EXPECT_TRUE(refused(run_carom({"generate", "--case", "cradle", "--json"}), 1, {"--json"}));
    EXPECT_TRUE(refused(run_carom({"generate"}), 1, {"found no N"}));
}

} // namespace
} // namespace carom
