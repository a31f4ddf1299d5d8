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

class ProcessesCommand : public testing::Test {
  protected:
    tests::ProgramResult processes(const Json& described, const std::vector<std::string>& more = {}) {
        std::vector<std::string> words{"processes", directory.write("processes.json", described.dump())};
        words.insert(words.end(), more.begin(), more.end());
        return run_carom(words);
    }

    Json described(const std::string& script, const std::string& record) const {
        return {
            {"command", {"/bin/sh", "-c", script}}, {"record", directory / record}, {"sources", {"/bin/sh"}}};
    }

    Json record(const std::string& name) const { return Json::parse(content_of(directory / name)); }

    tests::TemporaryDirectory directory;
};

TEST_F(ProcessesCommand, LeavesARecordOfEach) {
    const std::string scene =
        directory.write("scene.in", scene_text(tests::random_scene(50, 40, 1, 5, 1, 3)));
    Json first =
        described("i=0; while [ $i -lt 20000 ]; do i=$((i+1)); done; echo $OMP_NUM_THREADS > out", "one");
    first.update({{"folder", directory / ""},
                  {"environment", {{"OMP_NUM_THREADS", "3"}}},
                  {"tags", {"a=1", "b=x"}},
                  {"axes", {{"threads", 3}}},
                  {"threads", 3},
                  {"scene", scene},
                  {"build", {{"compiler", "GNU 1"}, {"openmp", {{"runtime", "none"}}}}},
                  {"checked", "trajectory"},
                  {"turns", true},
                  {"expected_seconds", 0.05}});
    Json second = described("exit 0", "two");
    second.update({{"turns", true}, {"expected_seconds", 0.05}});
    const auto result = processes({first, second}, {"--slice", "0.002", "--seed", "9"});
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.output, "");
    const Json one = record("one");
    EXPECT_EQ(one["kind"], "process");
    EXPECT_EQ(one["tags"], (Json{{"a", 1}, {"b", "x"}}));
    EXPECT_EQ(one["axes"], (Json{{"threads", 3}}));
    EXPECT_EQ(one["scene"]["particles"], 50);
    EXPECT_EQ(one["check"]["verdict"], "passed");
    EXPECT_EQ(one["check"]["scope"], "trajectory");
    EXPECT_EQ(one["process"]["command"], first["command"]);
    EXPECT_EQ(one["process"]["exit_code"], 0);
    EXPECT_EQ(one["process"]["time_from"], "outside");
    EXPECT_EQ(one["process"]["sources"][0]["path"], "/bin/sh");
    EXPECT_EQ(one["process"]["sources"][0]["sha256"], one["provenance"]["binary_sha256"]);
    EXPECT_EQ(one["provenance"]["openmp"]["environment"]["OMP_NUM_THREADS"], "3");
    EXPECT_EQ(one["provenance"]["openmp"]["runtime"], "none");
    EXPECT_EQ(one["provenance"]["compiler"], "GNU 1");
    EXPECT_TRUE(one["provenance"].contains("compiler_flags")) << "what is not said stays this program's";
    EXPECT_EQ(one["turns"]["contenders"], 2);
    EXPECT_EQ(one["turns"]["seed"], 9);
    EXPECT_GT(one["turns"]["seconds"].size(), 1);
    EXPECT_TRUE(one["turns"]["seconds_alone"].is_number());
    EXPECT_TRUE(one["process"]["undisturbed"].is_null());
    EXPECT_TRUE(one["process"]["tree"] == "cgroup" || one["process"]["tree"] == "subreaper");
    EXPECT_EQ(one["process"]["runs"], 1);
    EXPECT_EQ(one["process"]["changed"], Json::array());
    EXPECT_EQ(one["repetitions"][0]["steps_seconds"], one["process_seconds"]);
    EXPECT_EQ(content_of(directory / "out"), "3\n") << "it runs in its folder, with its environment";
    const Json two = record("two");
    EXPECT_TRUE(two["scene"].is_null());
    EXPECT_EQ(two["check"]["verdict"], "unchecked");
}

TEST_F(ProcessesCommand, LeavesAFailureInThePlaceOfARecord) {
    Json endless = described("sleep 60", "endless");
    endless["most_seconds"] = 0.05;
    Json missing = described("", "missing");
    missing["command"] = {"/no/such/program"};
    Json silent = described("echo nothing", "silent");
    silent["pattern"] = "took ([0-9]+)";
    const auto result = processes({described("echo first >&2; echo last >&2; exit 4", "exit"),
                                   described("kill -ABRT $$", "signal"), endless, missing, silent,
                                   described("exit 0", "right")});
    EXPECT_TRUE(refused(result, 1, {"/bin/sh: exit code 4: last"}));
    const auto failed = [this](const std::string& name) {
        const Json failure = record(name);
        EXPECT_EQ(failure["kind"], "failure");
        return std::to_string(failure["exit_code"].get<int>()) + " " + failure["reason"].get<std::string>();
    };
    EXPECT_EQ(failed("exit"), "4 exit code 4: last");
    EXPECT_EQ(failed("signal"), "-6 killed by SIGABRT");
    EXPECT_EQ(failed("endless"), "124 took longer than 0.05 s and was stopped");
    EXPECT_EQ(failed("missing"), "127 cannot be run: No such file or directory");
    EXPECT_EQ(failed("silent"), "1 time: 'took ([0-9]+)' matches 0 lines of standard output, expected one");
    EXPECT_EQ(record("right")["kind"], "process");
}

TEST_F(ProcessesCommand, TakesTheTimeThatAProgramSays) {
    Json printed = described("echo it took 250 ms", "printed");
    printed["pattern"] = "took ([0-9]+)";
    Json plain = described("echo it took 250", "plain");
    plain.update({{"pattern", "took ([0-9]+)"}, {"unit_seconds", 1e-3}});
    ASSERT_EQ(processes({printed, plain}).exit_code, 0);
    EXPECT_DOUBLE_EQ(record("printed")["repetitions"][0]["steps_seconds"], 0.25);
    EXPECT_DOUBLE_EQ(record("plain")["repetitions"][0]["steps_seconds"], 0.25);
    plain.erase("unit_seconds");
    EXPECT_TRUE(refused(processes(Json::array({plain})), 1, {"found '250' without a unit", "--unit"}));
    Json latin = described("printf 'it took 250 \\265s'", "latin");
    latin["pattern"] = "took ([0-9]+)";
    ASSERT_EQ(processes(Json::array({latin})).exit_code, 0);
    EXPECT_DOUBLE_EQ(record("latin")["repetitions"][0]["steps_seconds"], 250e-6);
    EXPECT_EQ(record("printed")["process"]["time_from"], "the program");
    EXPECT_TRUE(record("printed")["turns"].is_null());
    const std::string json =
        R"({"benchmarks": [{"name": "BM_x", "real_time": 3, "time_unit": "ms", "y": 7}]})";
    Json benchmark = described("echo '" + json + "' > " + (directory / "report"), "benchmark");
    benchmark.update({{"benchmark", "BM_x"}, {"output", directory / "report"}});
    ASSERT_EQ(processes(Json::array({benchmark})).exit_code, 0);
    EXPECT_DOUBLE_EQ(record("benchmark")["repetitions"][0]["steps_seconds"], 0.003);
    EXPECT_EQ(record("benchmark")["process"]["counters"], (Json{{"y", 7.0}}));
}

TEST_F(ProcessesCommand, RunsUntimedBefore) {
    Json counted = described("echo x >> " + (directory / "runs"), "counted");
    counted["warm_ups"] = 2;
    ASSERT_EQ(processes(Json::array({counted})).exit_code, 0);
    EXPECT_EQ(content_of(directory / "runs"), "x\nx\nx\n");
    EXPECT_EQ(record("counted")["warm_ups"], 2);
}

TEST_F(ProcessesCommand, RefusesWhatDescribesNoProcesses) {
    for (const Json& wrong : {Json{}, Json::array(), Json{{"command", {"ls"}}}}) {
        EXPECT_TRUE(refused(processes(wrong), 1, {"processes.json", "expected a JSON list"})) << wrong;
    }
    EXPECT_TRUE(refused(processes(Json::array({Json{{"command", {"ls"}}}})), 1, {"process 1", "record"}));
    EXPECT_TRUE(refused(processes(Json::array({Json{{"command", Json::array()}, {"record", "r"}}})), 1,
                        {"process 1", "command"}));
    EXPECT_TRUE(refused(processes(Json::array({{"ls"}})), 1, {"processes.json", "expected a JSON list"}));
}

TEST_F(ProcessesCommand, RefusesAProcessThatCannotBeBeforeAnyRuns) {
    const auto with = [this](const std::string& key, const Json& value) {
        Json one = described("echo x >> " + (directory / "runs"), "one");
        one[key] = value;
        return processes(Json::array({described("echo x >> " + (directory / "runs"), "first"), one}));
    };
    EXPECT_TRUE(refused(with("tags", {"x"}), 1, {"process 2", "--tag", "KEY=VALUE"}));
    EXPECT_TRUE(refused(with("command", "ls"), 1, {"process 2: command: found", "expected another kind"}));
    EXPECT_TRUE(refused(with("most_seconds", -1), 1, {"most_seconds: found -1, expected a number above 0"}));
    EXPECT_TRUE(refused(with("turns", "no"), 1, {"turns: found", "no", "expected another kind"}));
    EXPECT_TRUE(
        refused(with("record", directory / "first"), 1, {"process 2: record: found", "for two processes"}));
    EXPECT_TRUE(
        refused(with("command", {"ls", std::string("a\0b", 3)}), 1, {"command: found 'a?b' with a zero"}));
    EXPECT_TRUE(refused(with("warm_ups", -1), 1, {"warm_ups: found -1, expected a number of at least 0"}));
    EXPECT_TRUE(refused(with("rounds", 0), 1, {"rounds: found 0, expected a number of at least 1"}));
    EXPECT_TRUE(refused(with("unit_seconds", "ms"), 1, {"unit_seconds: found", "expected another kind"}));
    EXPECT_TRUE(refused(with("threads", 0), 1, {"threads: found 0, expected a number of at least 1"}));
    EXPECT_TRUE(refused(with("exit_codes", Json::array()), 1, {"exit_codes: found none"}));
    EXPECT_TRUE(refused(with("pattern", "(?i)took ([0-9]+)"), 1, {"time: found", "a regular expression"}));
    EXPECT_TRUE(refused(with("pattern", "took [0-9]+"), 1, {"time: found", "with one group"}));
    EXPECT_TRUE(refused(with("sources", {directory / "no"}), 1, {"/no: "}));
    EXPECT_TRUE(refused(with("record", directory / "none/one"), 1, {"none/one: cannot be written"}));
    EXPECT_FALSE(std::filesystem::exists(directory / "runs"));
}

TEST_F(ProcessesCommand, SaysWhatIsMeasuredWithoutAPauseAndWhy) {
    const auto result = processes({described("sleep 0.2", "one"), described("sleep 0.3", "two")});
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_NE(result.notes.find("measured without a pause, in a stretch of its own: it "), std::string::npos)
        << result.notes;
    EXPECT_GE(record("one")["process_seconds"], 0.2);
    EXPECT_GE(record("two")["process_seconds"], 0.3);
    EXPECT_TRUE(record("one")["turns"].is_null());
    EXPECT_TRUE(record("one")["process"]["undisturbed"].is_string());
}

TEST_F(ProcessesCommand, TellsWhichOfItsFilesAProgramChanged) {
    const std::string data = directory.write("data", "3\n1\n2\n");
    const std::string input = directory.write("input", "x\n");
    Json sorting = described("sort -o " + data + " " + data + "; touch " + input, "sorting");
    sorting["sources"] = {"/bin/sh", data, input};
    ASSERT_EQ(processes(Json::array({sorting})).exit_code, 0);
    EXPECT_EQ(record("sorting")["process"]["changed"], Json::array({data}));
    const std::string first = record("sorting")["process"]["sources"][1]["sha256"];
    // Its own output counts by what it was when it was first seen.
    sorting["written"] = {{data, first}};
    directory.write("data", "9\n8\n");
    const std::string hash = record("sorting")["provenance"]["binary_sha256"];
    ASSERT_EQ(processes(Json::array({sorting})).exit_code, 0);
    EXPECT_EQ(record("sorting")["process"]["changed"], Json::array());
    EXPECT_EQ(record("sorting")["provenance"]["binary_sha256"], hash);
}

TEST_F(ProcessesCommand, AllowsTheExitCodesThatAreFine) {
    Json found = described("echo x | grep -c y", "found");
    found["exit_codes"] = {0, 1};
    EXPECT_EQ(processes(Json::array({found})).exit_code, 0);
    EXPECT_EQ(record("found")["process"]["exit_code"], 1);
    EXPECT_EQ(record("found")["process"]["output_bytes"], 2);
}

TEST_F(ProcessesCommand, RunsShortOnesInRounds) {
    const std::string count =
        "echo x >> " + (directory / "runs") + "; n=$(wc -l < " + (directory / "runs") + ")";
    Json often = described(count + "; exit $((n % 2))", "often");
    often.update({{"rounds", 3}, {"exit_codes", {0, 1}}});
    ASSERT_EQ(processes({often, described("exit 0", "once")}).exit_code, 0);
    const Json record_of_often = record("often");
    EXPECT_EQ(record_of_often["process"]["exit_codes"], (Json{1, 0, 1}));
    EXPECT_EQ(record_of_often["process"]["exit_code"], 1);
    EXPECT_EQ(record_of_often["process"]["runs"], 3);
    EXPECT_EQ(record_of_often["repetitions"].size(), 3);
    EXPECT_EQ(record_of_often["turns"]["seconds"].size(), 3);
    EXPECT_EQ(record("once")["process"]["exit_codes"], (Json{0}));
}

TEST_F(ProcessesCommand, TellsTheMostMemoryOfAllRuns) {
    const std::string large = "head -c 200000000 /dev/zero | tail -n 1 > /dev/null";
    Json one = described("mkdir " + (directory / "once") + " 2> /dev/null && " + large + "; exit 0", "one");
    one["rounds"] = 2;
    ASSERT_EQ(processes(Json::array({one})).exit_code, 0);
    EXPECT_GT(record("one")["process"]["peak_memory_bytes"], 150'000'000);
}

TEST_F(ProcessesCommand, BenchmarksRunRoundAfterRoundAndNothingIsTakenTwice) {
    const std::string report = directory / "report";
    // It writes a time that grows with each run, and at last nothing.
    Json benchmark =
        described("echo x >> " + (directory / "runs") + "; n=$(wc -l < " + (directory / "runs") +
                      "); echo '{\"benchmarks\": [{\"name\": \"BM\", \"real_time\": '$n'}]}' > " + report +
                      "; sleep 0.2",
                  "benchmark");
    benchmark.update({{"benchmark", "BM"}, {"output", report}});
    ASSERT_EQ(processes(Json::array({benchmark})).exit_code, 0);
    const Json repetitions = record("benchmark")["repetitions"];
    EXPECT_GT(repetitions.size(), 2);
    EXPECT_EQ(record("benchmark")["process"]["runs"], repetitions.size());
    for (std::size_t k = 0; k < repetitions.size(); ++k) {
        EXPECT_DOUBLE_EQ(repetitions[k]["steps_seconds"], static_cast<double>(k + 1) * 1e-9);
    }
    Json forgetful = described("[ -e " + (directory / "once") + " ] || cp " + (directory / "first") + " " +
                                   report + "; touch " + (directory / "once"),
                               "forgetful");
    directory.write("first", R"({"benchmarks": [{"name": "BM", "real_time": 1}]})");
    forgetful.update({{"benchmark", "BM"}, {"output", report}});
    EXPECT_TRUE(refused(processes(Json::array({forgetful})), 1, {"report"}));
}

TEST_F(ProcessesCommand, RefusesTimesOfUnlikeVersionsOfALibrary) {
    const auto benchmark = [this](const std::string& name, const std::string& version) {
        const std::string json =
            R"({"context": {"library_version": ")" + version +
            R"("}, "benchmarks": [{"name": "BM", "threads": 4, "real_time": 3, "bad": NaN}]})";
        const std::string report = directory / (name + ".report");
        Json one =
            described("cp " + directory.write(name + ".json", json) + " " + report + "; sleep 0.5", name);
        one.update({{"benchmark", "BM"}, {"output", report}});
        return one;
    };
    const auto result = processes({benchmark("old", "v1.8.3"), benchmark("new", "v1.9.1")});
    EXPECT_TRUE(refused(result, 1, {"v1.8.3", "v1.9.1", "real_time"}));
    EXPECT_EQ(record("old")["kind"], "failure");
    EXPECT_EQ(record("new")["kind"], "failure");
    ASSERT_EQ(processes({benchmark("old", "v1.8.3"), benchmark("new", "v1.8.4")}).exit_code, 0);
    EXPECT_TRUE(record("old")["process"]["counters"]["bad"].is_null());
    EXPECT_EQ(record("old")["process"]["library_version"], "v1.8.3");
}

TEST_F(ProcessesCommand, RefusesSlicesThatCannotBe) {
    const Json one = Json::array({described("exit 0", "one")});
    EXPECT_TRUE(refused(processes(one, {"--slice", "0"}), 1,
                        {"--slice: found '0', expected a number from 0.001 to 1000000"}));
    EXPECT_TRUE(
        refused(processes(one, {"--seed", "-1"}), 1, {"--seed: found '-1', expected a whole number"}));
}

} // namespace
} // namespace carom
