#include <filesystem>
#include <fstream>
#include <numeric>
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
        std::vector<std::string> arguments{"turns", directory / "contenders.json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_carom(arguments);
    }

    Json record(const std::string& name) { return Json::parse(content_of(directory / name)); }

    Json words(const std::string& variant, const std::string& name,
               const std::vector<std::string>& more = {}) {
        Json list{scene, "--variant", variant, "--threads", "2", "--record", directory / name};
        for (const std::string& word : more) {
            list.push_back(word);
        }
        return list;
    }

    tests::TemporaryDirectory directory;
    const std::string scene = directory / "scene.in";
};

TEST_F(TurnsCommand, LeavesARecordForEachThatIsAsOfAProcessOfItsOwn) {
    const auto result = turns({words("published", "one", {"--tag", "series=a"}), words("nine", "two"),
                               words("published", "three", {"--substeps", "2"})},
                              {"--turn", "1e-6", "--seed", "7"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(result.error, "");
    const auto alone = run_carom({"bench", scene, "--threads", "2", "--record", directory / "alone"});
    ASSERT_EQ(alone.exit_code, 0) << alone.error;
    for (const char* field : {"state_hash", "work", "axes", "scene", "check", "warm_ups"}) {
        EXPECT_EQ(record("one")[field], record("alone")[field]) << field;
    }
    EXPECT_TRUE(record("alone")["turns"].is_null());
    EXPECT_EQ(record("one")["tags"], (Json{{"series", "a"}}));
    EXPECT_EQ(record("two")["axes"]["variant"], "nine");
    EXPECT_EQ(record("three")["axes"]["substeps"], 2);
    for (const char* name : {"one", "two", "three"}) {
        const Json turns = record(name)["turns"];
        EXPECT_EQ(turns["contenders"], 3);
        EXPECT_EQ(turns["seed"], 7);
        EXPECT_EQ(turns["rounds"], 10);
        EXPECT_EQ(turns["seconds"].size(), 10) << "two steps a turn";
        for (std::size_t turn = 0; turn < 10; ++turn) {
            EXPECT_EQ(turns["places"][turn].get<std::size_t>() / 3, turn) << "one of three in each round";
            EXPECT_LT(turns["returning_seconds"][turn], turns["seconds"][turn]);
        }
        const auto seconds = turns["seconds"].get<std::vector<double>>();
        EXPECT_NEAR(std::accumulate(seconds.begin(), seconds.end(), 0.0),
                    record(name)["repetitions"][0]["steps_seconds"].get<double>(), 1e-9);
        EXPECT_GE(record(name)["process_seconds"], record(name)["repetitions"][0]["steps_seconds"]);
    }
}

TEST_F(TurnsCommand, RepeatsWholeRunsOfAll) {
    const auto result = turns(
        {words("published", "one"), words("track", "two"), words("published", "slower", {"--substeps", "2"})},
        {"--runs", "3", "--turn", "1000"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const auto alone = run_carom({"bench", scene, "--threads", "2", "--record", directory / "alone"});
    ASSERT_EQ(alone.exit_code, 0) << alone.error;
    EXPECT_EQ(record("one")["state_hash"], record("alone")["state_hash"]);
    EXPECT_EQ(record("one")["work"], record("alone")["work"]);
    for (const char* name : {"one", "two", "slower"}) {
        const Json found = record(name);
        ASSERT_EQ(found["repetitions"].size(), 3);
        EXPECT_EQ(found["turns"]["rounds"], 1);
        ASSERT_EQ(found["turns"]["seconds"].size(), 3);
        for (std::size_t run = 0; run < 3; ++run) {
            const double seconds = found["turns"]["seconds"][run];
            EXPECT_NEAR(seconds, found["repetitions"][run]["steps_seconds"].get<double>(), 1e-9);
            EXPECT_LT(found["turns"]["returning_seconds"][run].get<double>(), seconds);
        }
    }
}

TEST_F(TurnsCommand, CountsOneAfterTheOther) {
    const auto result = turns({words("published", "one"), words("nine", "two")}, {"--counts"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const auto alone = run_carom({"bench", scene, "--threads", "2", "--record", directory / "alone"});
    ASSERT_EQ(alone.exit_code, 0) << alone.error;
    EXPECT_EQ(record("one")["work"], record("alone")["work"]);
    EXPECT_EQ(record("one")["state_hash"], record("alone")["state_hash"]);
    for (const char* name : {"one", "two"}) {
        EXPECT_TRUE(record(name)["turns"].is_null());
        EXPECT_EQ(record(name)["repetitions"].size(), 1);
        EXPECT_EQ(record(name)["check"]["verdict"], "passed");
    }
    EXPECT_TRUE(refused(turns({words("published", "one")}, {"--counts", "--runs", "2"}), 1, {"--counts"}));
}

TEST_F(TurnsCommand, LetsTheEventDrivenSimulationTakePart) {
    std::ofstream(scene) << scene_text(tests::cradle());
    ASSERT_EQ(turns({words("published", "one"), words("event_driven", "two")}, {"--turn", "1e-6"}).exit_code,
              0);
    const auto alone = run_carom({"run", scene, "--variant", "event_driven", "--json"});
    EXPECT_EQ(record("two")["state_hash"], Json::parse(alone.output)["state_hash"]);
    EXPECT_EQ(record("two")["turns"]["seconds"].size(), 30);
    EXPECT_EQ(record("two")["check"]["verdict"], "passed");
}

TEST_F(TurnsCommand, RefusesWhatIsNoListOfContenders) {
    const std::vector<std::string> expected{"contenders.json", "expected a JSON list"};
    for (const Json& wrong : {Json{}, Json::array(), Json{1}, Json{"scene.in"}, Json{Json{1, 2}}}) {
        EXPECT_TRUE(refused(turns(wrong), 1, expected)) << wrong;
    }
    std::ofstream(directory / "torn.json") << "[[\"scene.in\", ";
    EXPECT_TRUE(
        refused(run_carom({"turns", directory / "torn.json"}), 1, {"torn.json", "expected a JSON list"}));
    EXPECT_TRUE(refused(run_carom({"turns", directory / "none.json"}), 1, {"none.json"}));
}

TEST_F(TurnsCommand, RefusesAContenderThatCannotBeAndSaysWhichOne) {
    const Json right = words("published", "one");
    EXPECT_TRUE(refused(turns({right, Json{scene}}), 1, {"contender 2", "--record"}));
    EXPECT_TRUE(refused(turns({right, words("publishde", "two")}), 1, {"publishde", "published"}));
    EXPECT_TRUE(refused(turns({right, words("nine", "two", {"--tag", "x"})}), 1, {"--tag", "KEY=VALUE"}));
    EXPECT_TRUE(
        refused(turns({right, words("nine", "two", {"--no-such"})}), 1, {"contender 2", "--no-such"}));
    EXPECT_TRUE(refused(turns({right, Json{"--record", directory / "two"}}), 1,
                        {"contender 2: SCENE", "`carom bench --help`"}));
    EXPECT_TRUE(refused(turns({right, words("nine", "two", {"--recrod", "x"})}), 1,
                        {"contender 2: found '--recrod'", "did you mean '--record'?"}));
    EXPECT_TRUE(refused(turns({right, words("nine", "two", {"--repetitions", "3"})}), 1,
                        {"contender 2: --repetitions: found '3', expected 1"}));
    EXPECT_TRUE(refused(turns({right, words("nine", "none/two")}), 1, {"none/two: cannot be written"}));
    EXPECT_FALSE(std::filesystem::exists(directory / "one")) << "refused before any runs";
}

TEST_F(TurnsCommand, RefusesTurnsThatCannotBe) {
    const Json contenders{words("published", "one")};
    EXPECT_TRUE(refused(turns(contenders, {"--turn", "0"}), 1,
                        {"--turn: found '0', expected a number from 1e-06 to 1000000"}));
    EXPECT_TRUE(refused(turns(contenders, {"--runs", "0"}), 1, {"--runs: found '0'"}));
    EXPECT_TRUE(
        refused(turns(contenders, {"--seed", "-1"}), 1, {"--seed: found '-1', expected a whole number"}));
}

TEST_F(TurnsCommand, OneThatFailsItsCheckHasNoTimesAndTheOthersHave) {
    Scene wedged{.side = 3, .radius = 1, .steps = 3, .discs = {{1, 1.5, 1, 0}, {2, 1.5, -1, 0}}};
    std::ofstream(directory / "wedged.in") << scene_text(wedged);
    const Json endless{directory / "wedged.in", "--threads",     "1", "--record",
                       directory / "wedged",    "--sweep-limit", "1"};
    const auto result = turns({words("published", "one"), endless}, {"--runs", "2"});
    EXPECT_TRUE(refused(result, 2, {"wedged.in", "run 1 of 2: step 1: ", "sweeps"}));
    EXPECT_EQ(record("wedged")["check"]["verdict"], "failed");
    EXPECT_TRUE(record("wedged")["repetitions"].empty());
    EXPECT_EQ(record("one")["check"]["verdict"], "passed");
    EXPECT_EQ(record("one")["repetitions"].size(), 2);
}

} // namespace
} // namespace carom
