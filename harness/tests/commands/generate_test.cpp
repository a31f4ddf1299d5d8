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

ProgramResult generate_with(const std::vector<std::string>& more) {
    std::vector<std::string> words{"generate", "40", "100.5", "1.5", "7", "-2", "5"};
    words.insert(words.end(), more.begin(), more.end());
    return run_carom(words);
}

TEST(GenerateCommand, WritesTheSceneWhereItIsToldTo) {
    const TemporaryDirectory directory;
    const std::string path = directory / "scene.in";
    for (const std::vector<std::string>& more :
         std::vector<std::vector<std::string>>{{}, {"--output", "-"}, {"--output", path}}) {
        const ProgramResult result = generate_with(more);
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.error, "");
        EXPECT_EQ(result.output + (directory.empty() ? "" : content_of(path)), expected_text(1));
    }
    EXPECT_EQ(run_carom({"check", path}).exit_code, 0);
}

TEST(GenerateCommand, TakesASeed) {
    EXPECT_EQ(generate_with({"--seed", "12"}).output, expected_text(12));
    EXPECT_EQ(generate_with({"--seed", "18446744073709551615"}).output, expected_text(UINT64_MAX));
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

} // namespace
} // namespace carom
