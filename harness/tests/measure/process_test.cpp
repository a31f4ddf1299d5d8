#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "harness/measure/process.hpp"
#include "harness/support/stopwatch.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

ProcessCommand shell(const std::string& script) {
    return {.words = {"/bin/sh", "-c", script}, .folder = "", .environment = {"PATH=/usr/bin:/bin"}};
}

/// Works for a while without a pause.
ProcessCommand counting(int to) {
    return shell("i=0; while [ $i -lt " + std::to_string(to) + " ]; do i=$((i+1)); done");
}

ProcessEnd run(const ProcessCommand& command) {
    Process process(command);
    process.advance(60);
    EXPECT_TRUE(process.has_ended());
    return process.end();
}

TEST(Process, TellsHowItEnded) {
    const ProcessEnd end = run(shell("echo out; echo more; echo err >&2; exit 3"));
    EXPECT_EQ(end.exit_code, 3);
    EXPECT_EQ(end.signal, 0);
    EXPECT_EQ(end.output, "out\nmore\n");
    EXPECT_EQ(end.error, "err\n");
    EXPECT_EQ(end.not_started, "");
    EXPECT_FALSE(end.out_of_time);
    EXPECT_GT(end.peak_memory_bytes, 100'000);
    EXPECT_EQ(end.seconds.size(), 1);
    EXPECT_GT(end.wall_seconds(), 0);
    EXPECT_EQ(run(shell("kill -SEGV $$")).signal, SIGSEGV);
}

TEST(Process, GetsItsWordsAsTheyAreAndNothingElse) {
    const std::string word = "a b'\"$(id) {x}; rm";
    const ProcessEnd end =
        run({.words = {"/usr/bin/printf", "%s", word}, .folder = "", .environment = {"HOME=/"}});
    EXPECT_EQ(end.output, word);
    const tests::TemporaryDirectory directory;
    const ProcessEnd there = run({.words = {"sh", "-c", "pwd; echo $MINE; read line || echo nothing"},
                                  .folder = directory / "",
                                  .environment = {"MINE=yes"}});
    EXPECT_EQ(there.output, (directory / "").substr(0, (directory / "").size() - 1) + "\nyes\nnothing\n");
}

TEST(Process, ThatCannotBeStartedSaysWhy) {
    EXPECT_EQ(run({.words = {"/no/such/program"}, .folder = "", .environment = {}}).not_started,
              "No such file or directory");
    EXPECT_EQ(run({.words = {"/tmp"}, .folder = "", .environment = {}}).not_started, "Permission denied");
    EXPECT_EQ(run({.words = {"/bin/sh"}, .folder = "/no/such/folder", .environment = {}}).not_started,
              "No such file or directory");
}

TEST(Process, ThatTakesTooLongIsKilled) {
    ProcessCommand endless = counting(1'000'000'000);
    endless.most_seconds = 0.05;
    Process process(endless);
    process.advance(60);
    ASSERT_TRUE(process.has_ended());
    EXPECT_TRUE(process.end().out_of_time);
    EXPECT_EQ(process.end().signal, SIGKILL);
}

TEST(Process, TakesItsChildrenWithIt) {
    const ProcessEnd end = run(shell("sleep 600 & echo $!"));
    const std::string stat = "/proc/" + std::to_string(std::stoi(end.output)) + "/stat";
    // Where nobody collects orphans a dead one stays as a zombie.
    const auto is_alive = [&stat] {
        const std::string text = tests::content_of(stat);
        return !text.empty() && text.find(") Z") == std::string::npos;
    };
    for (int wait = 0; wait < 200 && is_alive(); ++wait) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_FALSE(is_alive());
}

TEST(Process, OnesInTurnRunOneAtATimeEachToItsEnd) {
    Process one(counting(60'000));
    Process two(counting(90'000));
    Process third(shell("exit 5"));
    const auto start = std::chrono::steady_clock::now();
    take_slices({&one, &two, &third}, 0.005, 3);
    const double elapsed = seconds_since(start);
    ASSERT_TRUE(one.has_ended() && two.has_ended() && third.has_ended());
    const ProcessEnd first = one.end();
    const ProcessEnd second = two.end();
    EXPECT_GT(first.seconds.size(), 2);
    EXPECT_GT(second.seconds.size(), first.seconds.size() - 2);
    EXPECT_EQ(third.end().exit_code, 5);
    EXPECT_LE(first.wall_seconds() + second.wall_seconds(), elapsed);
    for (const ProcessEnd& end : {first, second}) {
        EXPECT_EQ(end.exit_code, 0);
        // Standing still counts neither as wall nor as CPU time; clocks of a tick or so differ.
        EXPECT_GT(end.wall_seconds(), 0.8 * (end.user_seconds + end.system_seconds) - 0.02);
    }
}

TEST(Process, OneThatIsGivenUpHalfwayLeavesNothingBehind) {
    std::string number;
    const tests::TemporaryDirectory directory;
    {
        Process process(shell("echo $$ > " + (directory / "pid") + "; exec sleep 600"));
        for (int wait = 0; wait < 200 && number.empty(); ++wait) {
            process.advance(0.02);
            number = tests::content_of(directory / "pid");
        }
    }
    ASSERT_NE(number, "");
    EXPECT_NE(kill(std::stoi(number), 0), 0);
}

} // namespace
} // namespace carom
