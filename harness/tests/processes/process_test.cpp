#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/processes/descendants.hpp"
#include "harness/processes/process.hpp"
#include "harness/side_by_side/slices.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/tests/gone_processes.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

using Facts = nlohmann::ordered_json;

ProcessCommand words(const std::vector<std::string>& its) {
    return {.words = its, .environment = {"PATH=/usr/sbin:/usr/bin:/sbin:/bin"}};
}

ProcessCommand shell(const std::string& script) { return words({"/bin/sh", "-c", script}); }

/// Works for a while without a pause.
std::string counting(int to) {
    return "i=0; while [ $i -lt " + std::to_string(to) + " ]; do i=$((i+1)); done";
}

/// Either way of keeping together what a program starts: by a control group or by signals.
class ProcessKept : public testing::TestWithParam<bool> {
  protected:
    void SetUp() override {
        if (GetParam() && Cgroup::make() == nullptr) {
            GTEST_SKIP() << "no group of cgroups v2 can be made here";
        }
    }

    static std::unique_ptr<Cgroup> group() { return GetParam() ? Cgroup::make() : nullptr; }
    static Facts run(const ProcessCommand& command) { return run_undisturbed(command, group()); }

    tests::TemporaryDirectory directory;
};

INSTANTIATE_TEST_SUITE_P(, ProcessKept, testing::Values(true, false),
                         [](const auto& one) { return one.param ? "ByCgroup" : "BySubreaper"; });

TEST_P(ProcessKept, TellsHowItEnded) {
    const Facts end = run(shell("echo out; echo more; echo err >&2; exit 3"));
    EXPECT_EQ(end["exit_code"], 3);
    EXPECT_EQ(end["signal"], 0);
    EXPECT_EQ(end["output_end"], "out\nmore\n");
    EXPECT_EQ(end["output_bytes"], 9);
    EXPECT_EQ(end["error_end"], "err");
    EXPECT_EQ(end["not_started"], "");
    EXPECT_EQ(end["unknown"], "");
    EXPECT_EQ(end["out_of_time"], false);
    EXPECT_EQ(end["seconds"].size(), 1);
    EXPECT_GT(end["seconds"][0], 0);
    EXPECT_FALSE(succeeded(end));
    EXPECT_TRUE(succeeded(run(words({"true"}))));
    EXPECT_EQ(run(shell("kill -SEGV $$"))["signal"], SIGSEGV);
}

TEST_P(ProcessKept, GetsItsWordsAsTheyAreAndNothingElse) {
    const std::string word = "a b'\"$(id) {x}; rm";
    EXPECT_EQ(run(words({"/usr/bin/printf", "%s", word}))["output_end"], word);
    const Facts there = run({.words = {"sh", "-c", "pwd; echo $MINE; read line || echo nothing"},
                             .folder = directory.path(),
                             .environment = {"MINE=yes"}});
    EXPECT_EQ(there["output_end"], directory.path().string() + "\nyes\nnothing\n");
}

TEST_P(ProcessKept, HasNoTerminalAndSignalsAsTheyAreByDefault) {
    EXPECT_NE(run(shell("echo hello > /dev/tty"))["exit_code"], 0);
    std::signal(SIGCHLD, SIG_IGN);
    std::signal(SIGTERM, SIG_IGN);
    const Facts end = run(shell("kill -TERM $$; exit 3"));
    std::signal(SIGTERM, SIG_DFL);
    EXPECT_EQ(end["signal"], SIGTERM);
}

TEST_P(ProcessKept, ThatCannotBeStartedSaysWhyAndIsNotGivenToAShell) {
    for (const std::string no_program : {"/no/such/program", "no-such-program"}) {
        EXPECT_EQ(run(words({no_program}))["not_started"], "No such file or directory");
    }
    EXPECT_EQ(run(words({"/tmp"}))["not_started"], "Permission denied");
    ProcessCommand elsewhere = words({"/bin/sh"});
    elsewhere.folder = "/no/such/folder";
    EXPECT_EQ(run(elsewhere)["not_started"], "No such file or directory");
    for (const std::string content : {"", "\177ELF\2\1\1", "exit 0\n"}) {
        const std::string file = directory.write("sim", content);
        chmod(file.c_str(), 0755);
        EXPECT_EQ(run(words({file}))["not_started"], "Exec format error") << content;
    }
}

TEST_P(ProcessKept, ThatTakesTooLongIsKilledWhateverItIgnores) {
    ProcessCommand endless = shell("trap '' TERM INT HUP; " + counting(1'000'000'000));
    endless.most_seconds = 0.2;
    const Facts end = run(endless);
    EXPECT_EQ(end["out_of_time"], true);
    EXPECT_EQ(end["signal"], SIGKILL);
    EXPECT_EQ(end["went_on"], "");
}

TEST_P(ProcessKept, WaitsForAllThatItStartedWhateverGroupThatIsIn) {
    const Facts end = run(shell("setsid sh -c 'sleep 0.3; setsid sleep 0.3 & exit' & exit 0"));
    EXPECT_EQ(end["exit_code"], 0);
    EXPECT_GT(end["seconds"][0], 0.55);
    EXPECT_GT(end["seconds_left_behind"], 0.5);
}

TEST_P(ProcessKept, NamesWhatGoesOnWithoutItForTooLong) {
    ProcessCommand daemon = shell("setsid sleep 600 > /dev/null 2>&1 & echo $!; exit 0");
    daemon.most_seconds = 0.5;
    const Facts end = run(daemon);
    EXPECT_EQ(end["out_of_time"], true);
    EXPECT_EQ(end["exit_code"], 0);
    EXPECT_EQ(end["went_on"], "sleep");
    EXPECT_TRUE(tests::is_gone(std::stoi(end["output_end"].get<std::string>())));
}

TEST_P(ProcessKept, CountsTheTimeOfAllThatItStarted) {
    const auto cpu_seconds = [](const std::string& script) {
        const Facts end = run(shell(script));
        return end["user_seconds"].get<double>() + end["system_seconds"].get<double>();
    };
    EXPECT_GT(cpu_seconds("setsid sh -c '" + counting(300'000) + "' & exit 0"),
              0.3 * cpu_seconds(counting(300'000)));
}

TEST_P(ProcessKept, KeepsTheEndOfWhatItPrintsAndCountsTheRest) {
    const Facts end =
        run(shell("head -c 30000000 /dev/zero | tr '\\0' 'x'; echo; echo it took 5 ms; echo last"));
    EXPECT_EQ(end["output_bytes"], 30'000'001 + 18);
    const std::string printed = end["output_end"];
    EXPECT_LE(printed.size(), 65'536);
    EXPECT_TRUE(printed.ends_with("\nit took 5 ms\nlast\n"));
    ProcessCommand kept = shell("echo took 1 ms; seq 100000; printf 'took 3 ms'");
    kept.output_file = directory / "printed";
    EXPECT_EQ(run(kept)["output_bytes"], 588'914);
    const std::string all = tests::content_of(kept.output_file);
    EXPECT_EQ(all.size(), 588'914);
    EXPECT_TRUE(all.starts_with("took 1 ms\n1\n2\n") && all.ends_with("\n100000\ntook 3 ms"));
}

TEST_P(ProcessKept, TellsItsOwnMemoryOrNone) {
    const Facts small = run(words({"/bin/true"}));
    const Facts large = run(shell("head -c 200000000 /dev/zero | tail -n 1 > /dev/null"));
    const bool is_known = !small["memory_of"].get<std::string>().starts_with("no more than");
    EXPECT_EQ(small["peak_memory_bytes"].is_null(), !is_known);
    EXPECT_LT(is_known ? small["peak_memory_bytes"].get<int>() : 0, 50'000'000);
    EXPECT_GT(large["peak_memory_bytes"], 150'000'000);
}

TEST_P(ProcessKept, ThatStartsManyCanBeStoppedAtAnyMoment) {
    // Python starts them by vfork, in the middle of which nothing stands still by a signal.
    ProcessCommand many = words({"/usr/bin/env", "python3", "-c",
                                 "import subprocess\nfor i in range(200): subprocess.run(['/bin/true'])"});
    many.environment = {std::string("PATH=") + std::getenv("PATH")};
    many.most_seconds = 60;
    Process one(many, group());
    Process two(many, group());
    std::vector<Sliced> both{{.process = &one}, {.process = &two}};
    take_slices(both, 0.002, 1);
    for (const Process* process : {&one, &two}) {
        EXPECT_EQ(process->facts()["exit_code"], 0) << process->facts();
        EXPECT_EQ(process->facts()["out_of_time"], false);
        EXPECT_GT(process->facts()["seconds"].size(), 10);
    }
}

TEST_P(ProcessKept, StandsStillWithAllThatItStarted) {
    const std::string ticks = directory / "ticks";
    const std::string tick = "while :; do echo x >> " + ticks + "; sleep 0.005; done";
    Process process(shell("setsid sh -c '" + tick + "' & " + tick), group());
    process.advance(0.3);
    const auto stopped = tests::content_of(ticks).size();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_EQ(tests::content_of(ticks).size(), stopped);
    process.advance(0.3);
    EXPECT_GT(tests::content_of(ticks).size(), stopped);
}

TEST_P(ProcessKept, OnesInTurnEndTogetherThoughOneTakesTwiceAsLong) {
    const double shorter = run(shell(counting(100'000)))["seconds"][0];
    Process one(shell(counting(100'000)), group());
    Process two(shell(counting(200'000)), group());
    std::vector<Sliced> all{{.process = &one, .expected_seconds = shorter},
                            {.process = &two, .expected_seconds = 2 * shorter}};
    const double start = process_seconds();
    take_slices(all, 0.02, 3);
    const double elapsed = process_seconds() - start;
    EXPECT_GT(one.facts()["seconds"].size(), 2);
    EXPECT_LE(one.wall_seconds() + two.wall_seconds(), elapsed);
    for (const Process* process : {&one, &two}) {
        ASSERT_TRUE(process->has_ended());
        EXPECT_EQ(process->facts()["exit_code"], 0);
        // Standing still counts neither as wall nor as CPU time; clocks of a tick or so differ.
        EXPECT_GT(process->wall_seconds(), 0.8 * process->facts()["user_seconds"].get<double>() - 0.02);
    }
    EXPECT_TRUE(all[0].seconds_alone == 0 || all[1].seconds_alone == 0) << "there is but one last";
}

/// That it stands still is noticed when it does, not up to ten milliseconds later.
TEST_P(ProcessKept, OneThatIsStoppedSoonIsNotTakenForRunningOn) {
    constexpr double asked = 0.003;
    Process process(shell(counting(400'000)), group());
    while (!process.has_ended()) {
        process.advance(asked);
    }
    std::vector<double> slices = process.facts()["seconds"];
    ASSERT_GT(slices.size(), 20);
    std::ranges::sort(slices);
    EXPECT_LT(slices[slices.size() / 4], 2.5 * asked);
}

TEST(Slices, AreInProportionToWhatEachTakes) {
    std::vector<Sliced> all{{.process = nullptr, .expected_seconds = 0.02},
                            {.process = nullptr, .expected_seconds = 2}};
    EXPECT_EQ(lengths_of_slices(all, 0.05), (std::vector<double>{0.02, 2})) << "in one piece";
    all[0].expected_seconds = 1;
    EXPECT_EQ(lengths_of_slices(all, 0.05), (std::vector<double>{0.05, 0.1}));
    all[1].expected_seconds = 0;
    EXPECT_EQ(lengths_of_slices(all, 0.05), (std::vector<double>{0.05, 0.05}));
}

TEST_P(ProcessKept, OneThatIsGivenUpHalfwayLeavesNothingBehind) {
    {
        Process process(shell("setsid sleep 600 & echo $! > " + (directory / "pid") + "; wait"), group());
        for (int wait = 0; wait < 200 && tests::content_of(directory / "pid").empty(); ++wait) {
            process.advance(0.02);
        }
        ASSERT_EQ(kill(std::stoi(tests::content_of(directory / "pid")), 0), 0);
        EXPECT_TRUE(std::ranges::is_permutation(children_by_parent(getpid()), children_by_thread(getpid())));
    }
    EXPECT_TRUE(tests::is_gone(std::stoi(tests::content_of(directory / "pid"))));
}

TEST_P(ProcessKept, IfItsKeeperIsKilledNobodyTakesThatForAnEnd) {
    // The parent of the program is what keeps it.
    const Facts end = run(shell("sleep 600 & echo $! >&2; kill -9 $PPID; sleep 600"));
    EXPECT_NE(end["unknown"], "");
    EXPECT_FALSE(succeeded(end));
    for (const pid_t left : descendants_of(getpid())) {
        EXPECT_TRUE(tests::is_gone(left)) << name_of(left);
    }
}

TEST(VersionLine, IsTheFirstOfHoweverMuchIsPrinted) {
    const tests::TemporaryDirectory directory;
    const auto prints = [&directory](const std::string& script) {
        const std::string program = directory.write("program", "#!/bin/sh\n" + script);
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        return version_line(program);
    };
    EXPECT_EQ(prints("echo first $1; yes | head -c 3000000; echo; echo last"), "first --version");
    EXPECT_EQ(prints("echo first; exit 3"), "");
    EXPECT_EQ(version_line("carom-is-no-such-program"), "");
}

} // namespace
} // namespace carom
