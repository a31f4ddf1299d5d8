#include <algorithm>
#include <fstream>
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

using Json = nlohmann::json;
using tests::content_of;
using tests::refused;
using tests::run_carom;

class TurnsCommand : public testing::Test {
  protected:
    void SetUp() override {
        std::ofstream(scene) << scene_text(tests::random_scene_of_density(400, 0.6, 20, 9));
    }

    /// What the program says of contenders with these words.
    tests::ProgramResult turns(const Json& contenders, const std::vector<std::string>& more = {}) {
        std::ofstream(directory / "contenders.json") << contenders.dump();
        std::vector<std::string> arguments{"turns", directory / "contenders.json", "--record",
                                           directory / "record"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_carom(arguments);
    }

    Json record() { return Json::parse(content_of(directory / "record")); }
    Json contender(std::size_t place) { return record()["contenders"][place]; }

    /// The contender of a process of its own.
    Json alone() {
        const auto ended = run_carom({"bench", scene, "--threads", "2", "--record", directory / "alone"});
        EXPECT_EQ(ended.exit_code, 0) << ended.error;
        const Json found = Json::parse(content_of(directory / "alone"));
        EXPECT_TRUE(found["turns"].is_null());
        EXPECT_EQ(found["contenders"].size(), 1);
        return found["contenders"][0];
    }

    Json words(const std::string& variant, const std::vector<std::string>& more = {}) {
        Json list{scene, "--variant", variant, "--threads", "2"};
        for (const std::string& word : more) {
            list.push_back(word);
        }
        return list;
    }

    tests::TemporaryDirectory directory;
    const std::string scene = directory / "scene.in";
};

TEST_F(TurnsCommand, LeavesARecordOfAllWithEachAsInAProcessOfItsOwn) {
    const auto result = turns(
        {words("published", {"--tag", "series=a"}), words("nine"), words("published", {"--substeps", "2"})},
        {"--turn", "1e-6", "--seed", "7"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(result.error, "");
    const Json of_one = alone();
    for (const char* field : {"state_hash", "work", "axes", "scene", "check", "warm_ups"}) {
        EXPECT_EQ(contender(0)[field], of_one[field]) << field;
    }
    EXPECT_EQ(contender(0)["tags"], (Json{{"series", "a"}}));
    EXPECT_EQ(contender(1)["axes"]["variant"], "nine");
    EXPECT_EQ(contender(2)["axes"]["substeps"], 2);
    const Json found = record()["turns"];
    EXPECT_EQ(found["seed"], 7);
    EXPECT_EQ(found["rounds"], 10) << "two steps a turn";
    ASSERT_EQ(found["contenders"].size(), 30);
    std::vector<double> sums(3);
    for (std::size_t turn = 0; turn < 30; ++turn) {
        sums.at(found["contenders"][turn]) += found["seconds"][turn].get<double>();
        EXPECT_LT(found["returning_seconds"][turn], found["seconds"][turn]);
        if (turn % 3 == 0) {
            const auto round = found["contenders"].begin() + static_cast<std::ptrdiff_t>(turn);
            EXPECT_TRUE(std::is_permutation(round, round + 3, std::vector{0, 1, 2}.begin())) << turn;
        }
    }
    for (std::size_t place = 0; place < 3; ++place) {
        const double seconds = contender(place)["repetitions"][0]["steps_seconds"];
        EXPECT_NEAR(sums[place], seconds, 1e-9);
        EXPECT_GE(contender(place)["process_seconds"], seconds);
    }
}

TEST_F(TurnsCommand, RepeatsWholeRunsOfAll) {
    const auto result = turns({words("published"), words("track"), words("published", {"--substeps", "2"})},
                              {"--runs", "3", "--turn", "1000"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const Json of_one = alone();
    EXPECT_EQ(contender(0)["state_hash"], of_one["state_hash"]);
    EXPECT_EQ(contender(0)["work"], of_one["work"]);
    const Json found = record()["turns"];
    EXPECT_EQ(found["rounds"], 1);
    ASSERT_EQ(found["seconds"].size(), 9);
    for (std::size_t turn = 0; turn < 9; ++turn) {
        const Json repetitions = contender(found["contenders"][turn])["repetitions"];
        ASSERT_EQ(repetitions.size(), 3);
        const double seconds = found["seconds"][turn];
        EXPECT_NEAR(seconds, repetitions[turn / 3]["steps_seconds"].get<double>(), 1e-9);
        EXPECT_LT(found["returning_seconds"][turn].get<double>(), seconds);
    }
}

TEST_F(TurnsCommand, CountsOneAfterTheOther) {
    const auto result = turns({words("published"), words("nine")}, {"--counts"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const Json of_one = alone();
    EXPECT_EQ(contender(0)["work"], of_one["work"]);
    EXPECT_EQ(contender(0)["state_hash"], of_one["state_hash"]);
    EXPECT_TRUE(record()["turns"].is_null());
    for (const std::size_t place : {0U, 1U}) {
        EXPECT_EQ(contender(place)["repetitions"].size(), 1);
        EXPECT_EQ(contender(place)["check"]["verdict"], "passed");
    }
}

TEST_F(TurnsCommand, LetsTheEventDrivenSimulationTakePart) {
    std::ofstream(scene) << scene_text(tests::cradle());
    ASSERT_EQ(turns({words("published"), words("event_driven")}, {"--turn", "1e-6"}).exit_code, 0);
    const auto alone = run_carom({"run", scene, "--variant", "event_driven", "--json"});
    EXPECT_EQ(contender(1)["state_hash"], Json::parse(alone.output)["state_hash"]);
    EXPECT_EQ(record()["turns"]["seconds"].size(), 60);
    EXPECT_EQ(contender(1)["check"]["verdict"], "passed");
}

TEST_F(TurnsCommand, OneThatFailsItsCheckHasNoTimesAndTheOthersHave) {
    Scene wedged{.side = 3, .radius = 1, .steps = 3, .discs = {{1, 1.5, 1, 0}, {2, 1.5, -1, 0}}};
    std::ofstream(directory / "wedged.in") << scene_text(wedged);
    const Json endless{directory / "wedged.in", "--threads", "1", "--sweep-limit", "1"};
    const auto result = turns({words("published"), endless}, {"--runs", "2"});
    EXPECT_TRUE(refused(result, 2, {"wedged.in", "run 1 of 2: step 1: ", "sweeps"}));
    EXPECT_EQ(contender(1)["check"]["verdict"], "failed");
    EXPECT_TRUE(contender(1)["repetitions"].empty());
    EXPECT_EQ(contender(0)["check"]["verdict"], "passed");
    EXPECT_EQ(contender(0)["repetitions"].size(), 2);
}

} // namespace
} // namespace carom
