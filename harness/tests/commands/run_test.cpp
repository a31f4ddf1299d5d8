#include <charconv>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "harness/machine/threads.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/measure/measure.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/tests/busy_processes.hpp"
#include "harness/tests/program.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/fastest.hpp"
#include "variants/registry.hpp"

namespace carom {
namespace {

using tests::content_of;
using tests::ProgramResult;
using tests::refused;
using tests::run_carom;
using tests::TemporaryDirectory;

const Scene busy = tests::random_scene(150, 50, 1, 6, 2, 161);

class RunCommand : public testing::Test {
  protected:
    /// Runs and returns the summary.
    static nlohmann::json summary(std::vector<std::string> arguments,
                                  const std::vector<std::string>& environment = {}) {
        arguments.insert(arguments.begin(), "run");
        arguments.emplace_back("--json");
        const ProgramResult result = run_carom(arguments, environment);
        EXPECT_EQ(result.exit_code, 0) << result.error;
        EXPECT_EQ(result.error, "");
        return nlohmann::json::parse(result.output);
    }

    TemporaryDirectory directory;
    std::string scene = directory.write("scene.in", scene_text(busy));
};

TEST_F(RunCommand, SummarisesTheRunAsJson) {
    const auto json = summary({scene, "--threads", "2", "--variant", "published"});
    const tests::Outcome expected = tests::simulate<Policies{}>(busy);
    EXPECT_EQ(json["scene"], scene);
    EXPECT_EQ(json["variant"], "published");
    EXPECT_EQ(json["policies"]["neighbourhood"], "four");
    EXPECT_EQ(json["threads"], 2);
    EXPECT_EQ(json["substeps"], 1);
    EXPECT_EQ(json["particles"], 150);
    EXPECT_EQ(json["steps"], 6);
    EXPECT_EQ(json["state_hash"], state_hash(expected.discs));
    EXPECT_EQ(json["discs_outside"], discs_outside(busy, expected.discs));
    EXPECT_DOUBLE_EQ(json["overlaps_per_step"], static_cast<double>(expected.work.overlaps) / 6);
    EXPECT_DOUBLE_EQ(json["pair_resolves_per_step"], static_cast<double>(expected.work.pair_resolves) / 6);
    EXPECT_DOUBLE_EQ(json["wall_resolves_per_step"], static_cast<double>(expected.work.wall_resolves) / 6);
    EXPECT_DOUBLE_EQ(json["pair_attempts_per_step"], static_cast<double>(expected.work.pair_attempts) / 6);
    EXPECT_GE(expected.work.pair_attempts, expected.work.pair_resolves);
    EXPECT_DOUBLE_EQ(json["sweeps_per_step"], static_cast<double>(expected.work.sweeps) / 6);
    EXPECT_NEAR(json["energy_drift"], 0, 1e-13);
    const double seconds = json["steps_seconds"];
    EXPECT_GT(seconds, 0);
    double sum = 0;
    for (const char* part : {"reading_seconds", "setting_up_seconds", "steps_seconds", "rest_seconds"}) {
        EXPECT_GT(json[part], 0) << part;
        sum += json[part].get<double>();
    }
    EXPECT_NEAR(json["process_seconds"], sum, 1e-9);
    EXPECT_DOUBLE_EQ(json["steps_per_second"], 6 / seconds);
    EXPECT_DOUBLE_EQ(json["disc_steps_per_second"], 6 * 150 / seconds);
}

TEST_F(RunCommand, TakesThreadsAsItsSecondArgument) {
    EXPECT_EQ(summary({scene, "3"})["threads"], 3);
    EXPECT_EQ(summary({scene}, {"OMP_NUM_THREADS=2"})["threads"], 2);
    EXPECT_EQ(summary({scene, "1"}, {"OMP_NUM_THREADS=2"})["threads"], 1);
}

TEST_F(RunCommand, PassesOnSubstepsAndTolerance) {
    const Tuning tuning{.substeps = 3, .tolerance = Tolerance::published};
    const auto simulation = find_variant("published")->simulate(busy, tuning);
    const auto expected = run_scene(busy, *simulation, tuning, CheckScope::nothing);
    const auto json =
        summary({scene, "--variant", "published", "--substeps", "3", "--tolerance", "published"});
    EXPECT_EQ(json["substeps"], 3);
    EXPECT_EQ(json["state_hash"], state_hash(expected.discs));
    EXPECT_DOUBLE_EQ(json["sweeps_per_step"], static_cast<double>(expected.work.sweeps) / 18);

    const std::string slow = directory.write("slow.in", "2\n50\n1\n1\n0 20 20 0 0\n1 21 20 -5e-8 0\n");
    EXPECT_EQ(summary({slow, "--tolerance", "relative"})["pair_resolves_per_step"], 1);
    EXPECT_EQ(summary({slow, "--tolerance", "published"})["pair_resolves_per_step"], 0);
    EXPECT_EQ(summary({slow})["pair_resolves_per_step"], 1);
}

TEST_F(RunCommand, SaysThatADriftIsNotDefinedWhereNothingMoves) {
    const std::string still = directory.write("still.in", "1\n10\n1\n2\n0 5 5 0 0\n");
    EXPECT_TRUE(summary({still})["energy_drift"].is_null());
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "not defined", run_carom({"run", still}).output);
}

TEST_F(RunCommand, RunsScenesWithoutDiscsOrSteps) {
    EXPECT_EQ(summary({directory.write("empty.in", "0\n10\n1\n5\n")})["particles"], 0);
    const auto json = summary({directory.write("unmoved.in", "1\n10\n1\n0\n0 5 5 1 0\n")});
    EXPECT_EQ(json["steps"], 0);
    EXPECT_EQ(json["sweeps_per_step"], 0);
}

TEST_F(RunCommand, WritesTheTrajectoryInThePublishedColumnsOncePerUnitOfTime) {
    const std::string path = directory / "trajectory";
    for (const int substeps : {1, 5}) {
        const Tuning tuning{.substeps = substeps};
        EXPECT_EQ(run_carom({"run", scene, "--variant", "published", "--substeps", std::to_string(substeps),
                             "--trajectory", path})
                      .exit_code,
                  0);
        const auto simulation = find_variant("published")->simulate(busy, tuning);
        std::istringstream text(content_of(path));
        std::string line;
        for (int step = 0; step <= 6; ++step) {
            for (std::size_t disc = 0; disc < 150; ++disc) {
                std::string expected = std::to_string(step) + " ";
                append_disc(expected, disc, simulation->discs()[disc]);
                ASSERT_TRUE(std::getline(text, line));
                ASSERT_EQ(line + "\n", expected);
            }
            simulation->steps(substeps);
        }
        EXPECT_FALSE(std::getline(text, line));
    }
}

TEST_F(RunCommand, SummarisesASceneWhoseNameIsNoUtf8) {
    const std::string path = directory.write("\xff.in", scene_text(busy));
    const auto json = summary({path});
    EXPECT_EQ(json["particles"], 150);
}

TEST_F(RunCommand, PrintsAShortSummaryAndTellsStepsFromUnitsOfTime) {
    const std::string one = directory.write("one.in", "1\n10\n1\n1\n0 5 5 1 0\n");
    const std::string text =
        run_carom({"run", scene, "2", "--substeps", "8"}).output + run_carom({"run", one, "1"}).output;
    for (const char* part :
         {"150 discs, 6 units of time in 48 steps, variant ", ", 2 threads\n", ": 1 disc, 1 step, variant ",
          ", 1 thread\n", "reading", "setting up", "whole process", "steps/s", "disc-steps/s", "overlaps",
          "pair resolves", "sweeps", "energy drift", "discs outside"}) {
        EXPECT_PRED_FORMAT2(testing::IsSubstring, part, text);
    }
    const auto json = summary({scene, "--substeps", "8"});
    EXPECT_EQ(json["variant"], fastest_variant(busy).name) << "by itself";
    EXPECT_EQ(json["variant"], summary({scene, "--variant", "auto"})["variant"]);
    EXPECT_EQ(json["steps"], 6);
    EXPECT_EQ(json["steps_simulated"], 48);
    EXPECT_NEAR(json["steps_per_second"].get<double>() * json["steps_seconds"].get<double>(), 48, 1e-6);
}

/// As a user runs it: this test's own environment fixes the threads.
const std::vector<std::string> free_to_choose{"OMP_DYNAMIC", "OMP_NUM_THREADS"};

TEST_F(RunCommand, TakesOneThreadForFewDiscs) {
    EXPECT_EQ(summary({scene}, free_to_choose)["threads"], 1);
    const auto json = summary({scene, "2"}, free_to_choose);
    EXPECT_EQ(json["threads"], 1);
    EXPECT_EQ(json["threads_asked"], 2);
    EXPECT_PRED_FORMAT2(testing::IsSubstring, ", 1 thread (of 2)\n",
                        run_carom({"run", scene, "2"}, free_to_choose).output);
    EXPECT_EQ(summary({scene, "--threads", "2"}, {"OMP_DYNAMIC=false"})["threads"], 2);
    const int crowd = usable_processors() + 1;
    EXPECT_EQ(summary({scene, std::to_string(crowd)}, free_to_choose)["threads"], crowd) << "it is meant so";
}

TEST_F(RunCommand, TakesNoMoreThreadsThanOtherProgramsLeaveProcessors) {
    if (usable_processors() < 2) {
        GTEST_SKIP() << "one processor: there are no fewer threads than one";
    }
    const std::string many =
        directory.write("many.in", scene_text(tests::random_scene(3000, 900, 1, 1, 2, 5)));
    const std::string threads = std::to_string(usable_processors());
    const tests::BusyProcesses busy(static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)));
    const ProgramResult result = run_carom({"run", many, threads, "--json"}, free_to_choose);
    EXPECT_EQ(nlohmann::json::parse(result.output)["threads"], 1);
    EXPECT_PRED_FORMAT2(testing::IsSubstring,
                        "other programs had the processors: 1 thread in place of " + threads, result.notes);
    EXPECT_EQ(summary({many, threads}, {"OMP_DYNAMIC=false"})["threads"], usable_processors());
}

TEST_F(RunCommand, ReadsTheSceneFromStandardInput) {
    const ProgramResult result = run_carom({"run", "-", "2", "--json"}, {}, "", scene);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    const auto json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["scene"], "standard input");
    EXPECT_EQ(json["state_hash"], summary({scene})["state_hash"]);
    const std::string bad = directory.write("bad.in", "1\n10\n1\n5\n0 5 five 0 0\n");
    EXPECT_TRUE(refused(run_carom({"run", "-"}, {}, "", bad), 1,
                        {"carom: standard input:5: found 'five', expected a position y"}));
    EXPECT_TRUE(refused(run_carom({"run", "-"}), 1, {"standard input:1: found the end of the file"}));
}

TEST_F(RunCommand, TakesTheEventDrivenSimulationForAVariant) {
    const std::string apart = directory.write("apart.in", scene_text(tests::cradle()));
    const auto json = summary({apart, "--threads", "2", "--variant", "event_driven", "--errors"});
    EXPECT_EQ(json["variant"], "event_driven");
    EXPECT_EQ(json["threads"], 1);
    EXPECT_TRUE(json["policies"]["order"].is_null());
    EXPECT_GT(json["pair_resolves_per_step"], 0);
    EXPECT_LT(json["errors"]["trajectory"][0]["rms_distance"], 1e-13);
    const auto text = run_carom({"run", apart, "--variant", "event_driven"});
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "60 units of time, variant event_driven, 1 thread",
                        text.output);
    const auto checked = run_carom({"check", apart, "--variant", "event_driven", "--json"});
    EXPECT_EQ(nlohmann::json::parse(checked.output)["state_hash"], json["state_hash"]);
}

TEST_F(RunCommand, EndsInTheSameBitsWhereTheEventDrivenSimulationTakesSeveralThreads) {
    Scene scene = tests::lattice_scene(100, 0.5, 3); // 10 000 discs, which make ten tiles at most
    scene.steps = 2;
    const std::string large = directory.write("large.in", scene_text(scene));
    const auto alone = summary({large, "--threads", "1", "--variant", "event_driven"});
    const auto shared = summary({large, "--threads", "16", "--variant", "event_driven"});
    EXPECT_GT(shared["threads"], 4);
    EXPECT_LE(shared["threads"], 10) << "as many as there are tiles";
    EXPECT_EQ(shared["state_hash"], alone["state_hash"]);
    EXPECT_EQ(shared["pair_resolves_per_step"], alone["pair_resolves_per_step"]);
}

} // namespace
} // namespace carom
