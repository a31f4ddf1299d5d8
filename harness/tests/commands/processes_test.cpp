#include <algorithm>
#include <string>

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
using tests::run_carom;

class ProcessesCommand : public testing::Test {
  protected:
    tests::ProgramResult asked(const std::string& lines) {
        return run_carom({"processes"}, {}, "", directory.write("lines", lines));
    }

    /// What it tells of the processes of one plan.
    Json told(const Json& plan) {
        const auto result = asked(plan.dump());
        EXPECT_EQ(result.exit_code, 0) << result.error;
        return Json::parse(result.output);
    }

    static Json scripted(const std::string& script) { return {{"command", {"/bin/sh", "-c", script}}}; }

    tests::TemporaryDirectory directory;
};

TEST_F(ProcessesCommand, TellsTheFactsOfEachInItsOrder) {
    const std::string count = "i=0; while [ $i -lt 50000 ]; do i=$((i+1)); done";
    Json first = scripted(count + "; echo \"$MINE here\" > out; echo first; echo last; echo no >&2; exit 3");
    first.update({{"folder", directory / ""},
                  {"environment", {{"MINE", "yes"}}},
                  {"output_file", directory / "printed"},
                  {"expected_seconds", 0.1}});
    Json second = scripted(count + "; kill -ABRT $$");
    second["expected_seconds"] = 0.1;
    const Json facts =
        told({{"processes", {first, second}}, {"slice_seconds", 0.002}, {"seed", 18446744073709551615U}});
    const Json& one = facts.at(0);
    EXPECT_EQ(one["exit_code"], 3);
    EXPECT_EQ(one["output_end"], "first\nlast\n");
    EXPECT_EQ(one["output_bytes"], 11);
    EXPECT_EQ(one["error_end"], "no");
    EXPECT_EQ(one["suspended"], "");
    EXPECT_GT(one["seconds"].size(), 1) << "it stands still while the other one runs";
    EXPECT_GT(one["user_seconds"], 0);
    EXPECT_GE(one["idle_seconds"], 0);
    EXPECT_TRUE(one["tree"] == "cgroup" || one["tree"] == "subreaper");
    EXPECT_GT(one["counted"]["minor_page_faults"], 0);
    EXPECT_EQ(content_of(directory / "out"), "yes here\n");
    EXPECT_EQ(content_of(directory / "printed"), "first\nlast\n");
    EXPECT_EQ(facts.at(1)["signal"], 6);
}

TEST_F(ProcessesCommand, RunsOneWithoutAPauseAndEndsItAtItsLimit) {
    Json endless = scripted("sleep 60");
    endless["most_seconds"] = 0.05;
    const Json facts = told({{"processes", {endless}}});
    EXPECT_EQ(facts.at(0)["out_of_time"], true);
    EXPECT_EQ(facts.at(0)["seconds"].size(), 1);
    Json daemon = scripted("sleep 97 &");
    daemon["most_seconds_behind"] = 0.1;
    EXPECT_EQ(told({{"processes", {daemon}}}).at(0)["went_on"], "sleep");
    const Json missing{{"command", {"/no/such/program"}}};
    EXPECT_EQ(told({{"processes", {missing}}}).at(0)["not_started"], "No such file or directory");
}

TEST_F(ProcessesCommand, AnswersLineByLine) {
    const std::string plan = Json{{"processes", {scripted("exit 0")}}}.dump();
    const auto result = asked(plan + "\n" + plan + "\n");
    EXPECT_EQ(std::ranges::count(result.output, '\n'), 2);
}

TEST_F(ProcessesCommand, TellsTheMachineAndAScene) {
    const std::string scene =
        directory.write("scene.in", scene_text(tests::random_scene(50, 40, 1, 5, 1, 3)));
    const Json facts = told({{"threads", 1000}, {"scene", scene}});
    EXPECT_EQ(facts["scene"]["particles"], 50);
    EXPECT_EQ(facts["scene"]["name"], "scene.in");
    EXPECT_EQ(facts["provenance"]["oversubscribed"], true);
    EXPECT_TRUE(facts["provenance"].contains("compiler_flags"));
    EXPECT_TRUE(told({{"threads", 1}})["scene"].is_null());
}

} // namespace
} // namespace carom
