#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/processes/descendants.hpp"
#include "harness/processes/process.hpp"
#include "harness/side_by_side/slices.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

ProcessCommand shell(const std::string& script) {
    return {.words = {"/bin/sh", "-c", script}, .environment = {"PATH=/usr/sbin:/usr/bin:/sbin:/bin"}};
}

ProcessCommand words(const std::vector<std::string>& its) {
    return {.words = its, .environment = {"PATH=/usr/bin:/bin"}};
}

/// Works for a while without a pause.
std::string counting(int to) {
    return "i=0; while [ $i -lt " + std::to_string(to) + " ]; do i=$((i+1)); done";
}

bool is_alive(int process) { return kill(process, 0) == 0 && name_of(process) != std::to_string(process); }

/// Whether it is gone within some seconds; where nobody collects orphans a dead one may stay as a zombie.
bool is_gone(int process) {
    const std::string stat = "/proc/" + std::to_string(process) + "/stat";
    for (int wait = 0; wait < 500; ++wait) {
        const std::string text = tests::content_of(stat);
        if (text.empty() || text.find(") Z") != std::string::npos) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

/// Either way of keeping together what a program starts.
class ProcessKept : public testing::TestWithParam<KeptBy> {
  protected:
    void SetUp() override {
        if (GetParam() == KeptBy::whatever_works && Cgroup::make() == nullptr) {
            GTEST_SKIP() << "no group of cgroups v2 can be made here";
        }
    }

    ProcessEnd run(const ProcessCommand& command) const { return run_undisturbed(command, GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(, ProcessKept, testing::Values(KeptBy::whatever_works, KeptBy::subreaper),
                         [](const auto& one) {
                             return one.param == KeptBy::subreaper ? "BySubreaper" : "ByCgroup";
                         });

TEST_P(ProcessKept, TellsHowItEnded) {
    const ProcessEnd end = run(shell("echo out; echo more; echo err >&2; exit 3"));
    EXPECT_EQ(end.exit_code, 3);
    EXPECT_EQ(end.signal, 0);
    EXPECT_EQ(end.output.end, "out\nmore\n");
    EXPECT_EQ(end.output.bytes, 9);
    EXPECT_EQ(end.error.end, "err\n");
    EXPECT_EQ(end.not_started, "");
    EXPECT_EQ(end.unknown, "");
    EXPECT_FALSE(end.out_of_time);
    EXPECT_EQ(end.seconds.size(), 1);
    EXPECT_GT(end.wall_seconds(), 0);
    EXPECT_EQ(run(shell("kill -SEGV $$")).signal, SIGSEGV);
}

TEST_P(ProcessKept, GetsItsWordsAsTheyAreAndNothingElse) {
    const std::string word = "a b'\"$(id) {x}; rm";
    EXPECT_EQ(run(words({"/usr/bin/printf", "%s", word})).output.end, word);
    const tests::TemporaryDirectory directory;
    const ProcessEnd there = run({.words = {"sh", "-c", "pwd; echo $MINE; read line || echo nothing"},
                                  .folder = directory / "",
                                  .environment = {"MINE=yes"}});
    EXPECT_EQ(there.output.end, (directory / "").substr(0, (directory / "").size() - 1) + "\nyes\nnothing\n");
}

TEST_P(ProcessKept, HasNoTerminalAndSignalsAsTheyAreByDefault) {
    EXPECT_NE(run(shell("echo hello > /dev/tty")).exit_code, 0);
    std::signal(SIGCHLD, SIG_IGN);
    std::signal(SIGTERM, SIG_IGN);
    const ProcessEnd end = run(shell("kill -TERM $$; exit 3"));
    std::signal(SIGTERM, SIG_DFL);
    EXPECT_EQ(end.signal, SIGTERM);
}

TEST_P(ProcessKept, ThatCannotBeStartedSaysWhy) {
    EXPECT_EQ(run(words({"/no/such/program"})).not_started, "No such file or directory");
    EXPECT_EQ(run(words({"no-such-program"})).not_started, "No such file or directory");
    EXPECT_EQ(run(words({"/tmp"})).not_started, "Permission denied");
    ProcessCommand elsewhere = words({"/bin/sh"});
    elsewhere.folder = "/no/such/folder";
    EXPECT_EQ(run(elsewhere).not_started, "No such file or directory");
}

TEST_P(ProcessKept, WhatIsNoProgramIsNotGivenToAShell) {
    const tests::TemporaryDirectory directory;
    for (const std::string& content :
         {std::string(), std::string("\177ELF\2\1\1"), std::string("exit 0\n")}) {
        const std::string file = directory.write("sim", content);
        chmod(file.c_str(), 0755);
        EXPECT_EQ(run(words({file})).not_started, "Exec format error") << content;
    }
}

TEST_P(ProcessKept, ThatTakesTooLongIsKilledWhateverItIgnores) {
    ProcessCommand endless = shell("trap '' TERM INT HUP; " + counting(1'000'000'000));
    endless.most_seconds = 0.2;
    const ProcessEnd end = run(endless);
    EXPECT_TRUE(end.out_of_time);
    EXPECT_EQ(end.signal, SIGKILL);
    EXPECT_EQ(end.went_on, "");
}

TEST_P(ProcessKept, WaitsForAllThatItStartedWhateverGroupThatIsIn) {
    const ProcessEnd end = run(shell("setsid sh -c 'sleep 0.3; setsid sleep 0.3 & exit' & exit 0"));
    EXPECT_EQ(end.exit_code, 0);
    EXPECT_GT(end.wall_seconds(), 0.55);
}

TEST_P(ProcessKept, NamesWhatGoesOnWithoutItForTooLong) {
    ProcessCommand daemon = shell("setsid sleep 600 > /dev/null 2>&1 & echo $!; exit 0");
    daemon.most_seconds = 0.5;
    const ProcessEnd end = run(daemon);
    EXPECT_TRUE(end.out_of_time);
    EXPECT_EQ(end.exit_code, 0);
    EXPECT_EQ(end.went_on, "sleep");
    EXPECT_TRUE(is_gone(std::stoi(end.output.end)));
}

TEST_P(ProcessKept, CountsTheTimeOfAllThatItStarted) {
    const ProcessEnd by_itself = run(shell(counting(300'000)));
    const ProcessEnd by_others = run(shell("setsid sh -c '" + counting(300'000) + "' & exit 0"));
    EXPECT_GT(by_others.cpu_seconds(), 0.3 * by_itself.cpu_seconds());
}

TEST_P(ProcessKept, KeepsTheEndOfWhatItPrintsAndCountsTheRest) {
    const ProcessEnd end =
        run(shell("head -c 30000000 /dev/zero | tr '\\0' 'x'; echo; echo it took 5 ms; echo last"));
    EXPECT_EQ(end.output.bytes, 30'000'001 + 18);
    EXPECT_LE(end.output.end.size(), 65'536);
    EXPECT_TRUE(end.output.end.ends_with("\nit took 5 ms\nlast\n"));
    const tests::TemporaryDirectory directory;
    ProcessCommand kept = shell("echo took 1 ms; seq 100000; printf 'took 3 ms'");
    kept.output_file = directory / "printed";
    EXPECT_EQ(run(kept).output.bytes, 588'914);
    const std::string printed = tests::content_of(kept.output_file);
    EXPECT_EQ(printed.size(), 588'914);
    EXPECT_TRUE(printed.starts_with("took 1 ms\n1\n2\n") && printed.ends_with("\n100000\ntook 3 ms"));
}

TEST_P(ProcessKept, TellsItsOwnMemoryOrNone) {
    const ProcessEnd small = run(words({"/bin/true"}));
    const ProcessEnd large = run(shell("head -c 200000000 /dev/zero | tail -n 1 > /dev/null"));
    if (small.memory_of.starts_with("no more than")) {
        EXPECT_FALSE(small.peak_memory_bytes);
    } else {
        EXPECT_LT(small.peak_memory_bytes.value_or(0), 50'000'000);
    }
    EXPECT_GT(large.peak_memory_bytes.value_or(0), 150'000'000);
}

TEST_P(ProcessKept, ThatStartsManyCanBeStoppedAtAnyMoment) {
    // Python starts them by vfork, in the middle of which nothing stands still by a signal.
    ProcessCommand many = words({"/usr/bin/env", "python3", "-c",
                                 "import subprocess\nfor i in range(200): subprocess.run(['/bin/true'])"});
    many.environment = {std::string("PATH=") + std::getenv("PATH")};
    many.most_seconds = 60;
    Process one(many, GetParam());
    Process two(many, GetParam());
    std::vector<Sliced> both{{.process = &one}, {.process = &two}};
    take_slices(both, 0.002, 1);
    for (const Process* process : {&one, &two}) {
        EXPECT_EQ(process->end().exit_code, 0) << process->end().error.end;
        EXPECT_FALSE(process->end().out_of_time);
        EXPECT_GT(process->end().seconds.size(), 10);
    }
}

TEST_P(ProcessKept, StandsStillWithAllThatItStarted) {
    const tests::TemporaryDirectory directory;
    const std::string ticks = directory / "ticks";
    const std::string tick = "while :; do echo x >> " + ticks + "; sleep 0.005; done";
    Process process(shell("setsid sh -c '" + tick + "' & " + tick), GetParam());
    process.advance(0.3);
    const auto stopped = tests::content_of(ticks).size();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_EQ(tests::content_of(ticks).size(), stopped);
    process.advance(0.3);
    EXPECT_GT(tests::content_of(ticks).size(), stopped);
}

TEST_P(ProcessKept, OnesInTurnEndTogetherThoughOneTakesTwiceAsLong) {
    const double shorter = run(shell(counting(100'000))).wall_seconds();
    Process one(shell(counting(100'000)), GetParam());
    Process two(shell(counting(200'000)), GetParam());
    std::vector<Sliced> all{{.process = &one, .expected_seconds = shorter},
                            {.process = &two, .expected_seconds = 2 * shorter}};
    const double start = process_seconds();
    take_slices(all, 0.02, 3);
    const double elapsed = process_seconds() - start;
    ASSERT_TRUE(one.has_ended() && two.has_ended());
    EXPECT_GT(one.end().seconds.size(), 2);
    EXPECT_LE(one.end().wall_seconds() + two.end().wall_seconds(), elapsed);
    for (const Process* process : {&one, &two}) {
        EXPECT_EQ(process->end().exit_code, 0);
        // Standing still counts neither as wall nor as CPU time; clocks of a tick or so differ.
        EXPECT_GT(process->end().wall_seconds(), 0.8 * process->end().cpu_seconds() - 0.02);
    }
    EXPECT_TRUE(all[0].seconds_alone == 0 || all[1].seconds_alone == 0) << "there is but one last";
}

/// That it stands still is noticed when it does, not up to ten milliseconds later.
TEST_P(ProcessKept, OneThatIsStoppedSoonIsNotTakenForRunningOn) {
    constexpr double asked = 0.003;
    Process process(shell(counting(400'000)), GetParam());
    while (!process.has_ended()) {
        process.advance(asked);
    }
    std::vector<double> slices = process.end().seconds;
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
    const tests::TemporaryDirectory directory;
    {
        Process process(shell("setsid sleep 600 & echo $! > " + (directory / "pid") + "; wait"), GetParam());
        for (int wait = 0; wait < 200 && tests::content_of(directory / "pid").empty(); ++wait) {
            process.advance(0.02);
        }
        ASSERT_TRUE(is_alive(std::stoi(tests::content_of(directory / "pid"))));
    }
    EXPECT_TRUE(is_gone(std::stoi(tests::content_of(directory / "pid"))));
}

TEST_P(ProcessKept, IfItsKeeperIsKilledNobodyTakesThatForAnEnd) {
    // The parent of the program is what keeps it.
    const ProcessEnd end = run(shell("sleep 600 & echo $! >&2; kill -9 $PPID; sleep 600"));
    EXPECT_NE(end.unknown, "");
    EXPECT_FALSE(end.succeeded());
    for (const pid_t left : descendants_of(getpid())) {
        EXPECT_TRUE(is_gone(left)) << name_of(left);
    }
}

} // namespace
} // namespace carom
