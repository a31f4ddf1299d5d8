#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/side_by_side/contender_run.hpp"
#include "harness/side_by_side/stopping.hpp"
#include "harness/side_by_side/together.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

ProgramContender contender(const std::vector<std::string>& words) {
    ProgramContender one;
    one.command = {
        .words = words, .environment = {std::string("PATH=") + std::getenv("PATH")}, .most_seconds = 60};
    one.failure = [command = one.command](const ProcessEnd& end) { return why_failed(command, end, {0}); };
    return one;
}

ProgramContender scripted(const std::string& script) { return contender({"/bin/sh", "-c", script}); }

ProgramContender python(const std::string& script) { return contender({"python3", "-c", script}); }

const std::string work = "i=0; while [ $i -lt 150000 ]; do i=$((i+1)); done";
const std::string work_more = "; while [ $i -lt 400000 ]; do i=$((i+1)); done";

const std::string no_terminal = "it had no terminal: its standard input is empty, its outputs are pipes";

std::string lines_of(const std::string& path) { return tests::content_of(path); }

TEST(Together, WhatOnlyWorksTakesTurns) {
    // Where other programs have the processors nobody can tell one that waits for them from one that sleeps.
    ProgramContender one = scripted(work);
    one.turns = true;
    const auto measured = measure_together({one, one}, {.slice_seconds = 0.01});
    for (const Measured& each : measured) {
        EXPECT_EQ(each.failure, "");
        EXPECT_TRUE(each.sliced);
        EXPECT_EQ(each.undisturbed, "");
        ASSERT_EQ(each.runs.size(), 1);
        EXPECT_GT(each.runs.front().seconds.size(), 3);
    }
}

TEST(Together, WhatSleepsIsMeasuredWithoutAPause) {
    const auto measured =
        measure_together({scripted("sleep 0.3"), scripted("sleep 0.4")}, {.slice_seconds = 0.02});
    EXPECT_GE(measured[0].runs.front().wall_seconds(), 0.3);
    EXPECT_GE(measured[1].runs.front().wall_seconds(), 0.4);
    for (const Measured& each : measured) {
        EXPECT_FALSE(each.sliced);
        EXPECT_NE(each.undisturbed, "");
        EXPECT_EQ(each.runs.front().seconds.size(), 1);
    }
}

TEST(Together, WhatFailsInSlicesIsMeasuredWithoutAPause) {
    const ProgramContender minds = python("import sys, time\n"
                                          "start = last = time.monotonic()\n"
                                          "while last - start < 1.2:\n"
                                          "    now = time.monotonic()\n"
                                          "    if now - last > 0.3: sys.exit('stood still')\n"
                                          "    last = now\n");
    ProgramContender other = scripted("i=0; while [ $i -lt 2000000 ]; do i=$((i+1)); done");
    other.turns = true;
    other.expected_seconds = 1.2;
    const auto measured = measure_together({minds, other}, {.slice_seconds = 0.4});
    EXPECT_EQ(measured[0].failure, "");
    EXPECT_FALSE(measured[0].sliced);
    EXPECT_NE(measured[0].undisturbed, "");
    EXPECT_GE(measured[0].runs.front().wall_seconds(), 1.2);
    EXPECT_EQ(measured[1].failure, "");
}

TEST(Together, WhatLooksAtTheClockIsMeasuredWithoutAPause) {
    const ProgramContender minds = python("import time\n"
                                          "until = time.monotonic() + 1.6\n"
                                          "while time.monotonic() < until: pass\n");
    ProgramContender other = scripted("i=0; while [ $i -lt 2500000 ]; do i=$((i+1)); done");
    other.turns = true;
    other.expected_seconds = 1.6;
    const auto measured = measure_together({minds, other}, {.slice_seconds = 0.05});
    EXPECT_FALSE(measured[0].sliced);
    EXPECT_GE(measured[0].runs.front().wall_seconds(), 1.6);
    EXPECT_NE(measured[0].undisturbed, "");
}

TEST(Together, WhatWaitForOneAnotherAreMeasuredWithoutAPause) {
    const tests::TemporaryDirectory directory;
    const std::string lock = directory / "lock";
    const ProgramContender one = scripted("until mkdir " + lock + " 2> /dev/null; do :; done; " + work +
                                          work_more + "; rmdir " + lock);
    const auto measured = measure_together({one, one}, {.slice_seconds = 0.02});
    for (const Measured& each : measured) {
        EXPECT_EQ(each.failure, "");
        EXPECT_FALSE(each.sliced);
        EXPECT_NE(each.undisturbed, "");
        ASSERT_EQ(each.runs.size(), 1);
        EXPECT_EQ(each.runs.front().seconds.size(), 1);
    }
    const auto tells = [](const Measured& each) {
        return each.undisturbed.find("and the others stand still while it runs") != std::string::npos;
    };
    EXPECT_TRUE(std::ranges::any_of(measured, tells)) << measured[0].undisturbed;
}

TEST(Together, WhatFindsALockLeftEndsAtItsLimit) {
    const tests::TemporaryDirectory directory;
    ProgramContender one = scripted("until mkdir " + (directory / "") + " 2> /dev/null; do :; done");
    one.command.most_seconds = 0.3;
    for (const Measured& each : measure_together({one, one}, {})) {
        EXPECT_TRUE(each.failure.ends_with("and was stopped")) << each.failure;
    }
}

TEST(Together, AFailureInSlicesNamesNoCauseThatIsNotKnown) {
    ProgramContender minds = scripted(work + "; exit 3");
    minds.turns = true;
    const auto measured = measure_together({minds, minds}, {.slice_seconds = 0.002});
    EXPECT_EQ(measured[0].failure, "exit code 3 without a word; " + no_terminal);
}

TEST(Together, WhatIsLeftInTheBackgroundBeforeARunIsNoticedSoon) {
    ProgramContender one = scripted("true");
    one.prepare = {"sh", "-c", "sleep 97 &"};
    const auto measured = measure_together({one}, {});
    EXPECT_TRUE(measured[0].failure.starts_with("prepare: left sleep running")) << measured[0].failure;
}

TEST(Together, NothingIsStoppedThatIsNotToBe) {
    ProgramContender one = scripted(work);
    one.turns = false;
    const auto measured = measure_together({one, one}, {.slice_seconds = 0.002});
    for (const Measured& each : measured) {
        EXPECT_FALSE(each.sliced);
        EXPECT_EQ(each.undisturbed, "");
        EXPECT_EQ(each.runs.front().seconds.size(), 1);
    }
}

TEST(Together, EachRunIsPreparedAndConcluded) {
    const tests::TemporaryDirectory directory;
    ProgramContender one =
        scripted("mkdir " + (directory / "out") + " && echo run >> " + (directory / "log"));
    one.prepare = {"sh", "-c", "echo prepare >> " + (directory / "log")};
    one.conclude = {"rmdir", directory / "out"};
    one.warm_ups = 1;
    const auto measured = measure_together({one}, {});
    EXPECT_EQ(measured[0].failure, "");
    EXPECT_EQ(lines_of(directory / "log"), "prepare\nrun\nprepare\nrun\n");
    one.prepare = {"sh", "-c", "echo no room >&2; exit 1"};
    EXPECT_EQ(measure_together({one}, {})[0].failure, "prepare: exit code 1: no room");
    one.prepare = {"/no/such/program"};
    EXPECT_EQ(measure_together({one}, {})[0].failure, "prepare: cannot be run: No such file or directory");
    one.prepare.clear();
    one.conclude = {"false"};
    EXPECT_EQ(measure_together({one}, {})[0].failure, "conclude: exit code 1 without a word; " + no_terminal);
}

TEST(Together, EachRunHasAFolderOfItsOwnIfItAsksForOne) {
    const tests::TemporaryDirectory directory;
    ProgramContender one =
        scripted("test \"$(ls)\" = prepared && mkdir out && pwd >> " + (directory / "log"));
    one.prepare = {"touch", "prepared"};
    one.fresh_folder = true;
    one.warm_ups = 2;
    EXPECT_EQ(measure_together({one}, {})[0].failure, "");
    const std::string folders = lines_of(directory / "log");
    EXPECT_EQ(std::ranges::count(folders, '\n'), 3);
    EXPECT_FALSE(std::filesystem::exists(folders.substr(0, folders.find('\n'))));
}

TEST(Together, ShortProcessesThatTimeThemselvesGoRoundAfterRound) {
    const tests::TemporaryDirectory directory;
    const auto benchmark = [&directory](const std::string& name) {
        ProgramContender one = scripted("echo " + name + " >> " + (directory / "log"));
        one.times_itself = true;
        one.most_rounds = 5;
        return one;
    };
    int taken = 0;
    ProgramContender counted = benchmark("a");
    counted.take = [&taken](const ProcessEnd&) {
        ++taken;
        return std::string();
    };
    ProgramContender once = scripted("echo once >> " + (directory / "log"));
    once.times_itself = true;
    const auto measured = measure_together({counted, benchmark("b"), once}, {});
    EXPECT_EQ(measured[0].runs.size(), 5);
    EXPECT_EQ(measured[1].runs.size(), 5);
    EXPECT_EQ(measured[2].runs.size(), 1);
    EXPECT_EQ(taken, 5);
    std::string rounds = lines_of(directory / "log");
    rounds.erase(rounds.find("once\n"), 5);
    std::erase(rounds, '\n');
    for (std::size_t round = 0; round < 5; ++round) {
        const std::string pair = rounds.substr(2 * round, 2);
        EXPECT_TRUE(pair == "ab" || pair == "ba") << rounds;
    }
}

TEST(Together, ShortOnesRunAsOftenAsTheySayAroundTheOthers) {
    const tests::TemporaryDirectory directory;
    const auto short_one = [&directory](const std::string& name, int rounds) {
        ProgramContender one =
            scripted("(sleep 0.002; printf " + name + " >> " + (directory / "log") + ") &");
        one.prepare = {"sh", "-c", "printf '(' >> " + (directory / "log")};
        one.conclude = {"sh", "-c", "printf ')' >> " + (directory / "log")};
        one.rounds = rounds;
        return one;
    };
    std::vector<ProgramContender> all{short_one("a", 8), short_one("b", 4), short_one("c", 1)};
    all[0].warm_ups = 1;
    const auto measured = measure_together(all, {.seed = 7});
    EXPECT_EQ(measured[0].runs.size(), 8);
    EXPECT_EQ(measured[1].runs.size(), 4);
    EXPECT_EQ(measured[2].runs.size(), 1);
    EXPECT_FALSE(measured[0].sliced);
    std::string log = lines_of(directory / "log");
    EXPECT_EQ(log.size(), 3 * 14) << log;
    EXPECT_EQ(log.substr(0, 3), "(a)") << "first the run that does not count";
    for (std::size_t at = 0; at < log.size(); at += 3) {
        EXPECT_TRUE(log[at] == '(' && log[at + 2] == ')') << "each is waited for: " << log;
    }
    std::erase_if(log, [](char letter) { return letter == '(' || letter == ')' || letter == 'c'; });
    for (std::size_t begin = 1; begin < log.size(); begin += 3) {
        EXPECT_EQ(std::ranges::count(log.substr(begin, 3), 'b'), 1) << "one in each quarter: " << log;
    }
}

TEST(Together, ThoseInRoundsSurroundWhatTakesTurns) {
    const tests::TemporaryDirectory directory;
    ProgramContender sliced = scripted(work + "; echo sliced >> " + (directory / "log"));
    sliced.turns = true;
    ProgramContender often = scripted("echo often >> " + (directory / "log"));
    often.rounds = 3;
    often.turns = true;
    const auto measured = measure_together({sliced, often, sliced}, {.slice_seconds = 0.01});
    EXPECT_TRUE(measured[0].sliced && measured[2].sliced);
    EXPECT_FALSE(measured[1].sliced);
    EXPECT_EQ(measured[1].runs.size(), 3);
    ProgramContender fails =
        scripted("echo x >> " + (directory / "runs") + "; [ $(wc -l < " + (directory / "runs") + ") -lt 3 ]");
    fails.rounds = 9;
    EXPECT_NE(measure_together({fails, often}, {})[0].failure, "");
    EXPECT_EQ(lines_of(directory / "runs"), "x\nx\nx\n") << "after a failure no more";
}

ProcessEnd taking(double wall, double cpu) {
    ProcessEnd end;
    end.seconds = {wall};
    end.user_seconds = cpu;
    return end;
}

TEST(Stopping, IsMindedByWhatIsIdleThoughThereIsAProcessor) {
    EXPECT_EQ(why_idle(taking(1.0, 0.9), 1), "");
    EXPECT_EQ(
        why_idle(taking(1.0, 0.25), 1),
        "it computes for only 25 % of its time, and what it waits for would go on while it stands still");
    EXPECT_EQ(why_idle(taking(1.0, 0.25), 0.2), "") << "it may have waited for a processor";
    EXPECT_EQ(why_idle(taking(0.001, 0), 1), "");
    EXPECT_GT(idle_seconds_of_machine(), 0);
}

TEST(Stopping, IsMindedByWhatDisagreesBeyondNoise) {
    const std::vector<ProcessEnd> undisturbed{taking(1.0, 1.0), taking(1.4, 1.4), taking(1.1, 1.1)};
    EXPECT_FALSE(may_disagree(undisturbed, {taking(0.95, 0.95), taking(1.2, 1.2), taking(1.0, 1.0)}));
    EXPECT_TRUE(may_disagree(undisturbed, {taking(0.5, 0.5), taking(0.6, 0.6), taking(0.7, 0.7)}));
    EXPECT_TRUE(may_disagree(undisturbed, {taking(1.6, 1.6), taking(1.7, 1.7), taking(2, 2)}));
    // What sleeps for a sixth of its time saves that in slices, on a fast machine as on a slow one.
    const std::vector<ProcessEnd> waiting{taking(1.2, 1.0), taking(1.8, 1.5), taking(1.2, 1.0)};
    EXPECT_TRUE(may_disagree(waiting, {taking(1.2, 1.2), taking(1.5, 1.5), taking(1.1, 1.1)}));
    EXPECT_FALSE(may_disagree(waiting, {taking(1.2, 1.0), taking(1.5, 1.25), taking(1.1, 0.9)}));
}

TEST(Stopping, IsNotToldByWaitingForAProcessor) {
    ProcessEnd waited = taking(2.5, 0.9);
    EXPECT_TRUE(may_disagree({taking(1.0, 0.9)}, {waited}));
    waited.waited_seconds = 1.5;
    EXPECT_FALSE(may_disagree({taking(1.0, 0.9)}, {waited}));
}

} // namespace
} // namespace carom
