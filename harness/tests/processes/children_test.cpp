#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/processes/process.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

/// As a program is started by one that does not care how its children end.
class IgnoredChildren {
  public:
    IgnoredChildren() { before_ = std::signal(SIGCHLD, SIG_IGN); }
    ~IgnoredChildren() { std::signal(SIGCHLD, before_); }
    IgnoredChildren(const IgnoredChildren&) = delete;
    IgnoredChildren& operator=(const IgnoredChildren&) = delete;

  private:
    void (*before_)(int);
};

ProcessEnd run_of(const std::vector<std::string>& words) { return run_undisturbed({.words = words}); }

TEST(RunUndisturbed, FindsAProgramOnPathAndTellsHowItEnded) {
    EXPECT_TRUE(run_of({"true"}).succeeded());
    EXPECT_EQ(run_of({"sh", "-c", "exit 3"}).exit_code, 3);
    EXPECT_FALSE(run_of({"sh", "-c", "exit 3"}).succeeded());
    EXPECT_EQ(run_of({"sh", "-c", "kill -KILL $$"}).signal, SIGKILL);
    EXPECT_FALSE(run_of({"sh", "-c", "kill -KILL $$"}).succeeded());
    EXPECT_NE(run_of({"carom-is-no-such-program"}).not_started, "");
    EXPECT_FALSE(run_of({"carom-is-no-such-program"}).succeeded());
}

TEST(RunUndisturbed, KnowsTheEndThoughNobodyCaresHowChildrenEnd) {
    for (const int exit_code : {0, 3}) {
        const IgnoredChildren ignored;
        const ProcessEnd end = run_of({"sh", "-c", "exit " + std::to_string(exit_code)});
        EXPECT_EQ(end.unknown, "");
        EXPECT_EQ(end.exit_code, exit_code);
        EXPECT_EQ(end.succeeded(), exit_code == 0);
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
    EXPECT_EQ(prints("exit 0"), "");
    EXPECT_EQ(version_line("carom-is-no-such-program"), "");
}

TEST(Program, KnowsHowItsChildrenEndWhoeverStartedIt) {
    const ProcessEnd end = run_of({"sh", "-c",
                                   R"(trap '' CHLD
                                      echo '{"processes": [{"command": ["sh", "-c", "exit 3"]}]}' |
                                          "$0" "$@")",
                                   CAROM_PROGRAM, "processes"});
    EXPECT_EQ(end.exit_code, 0);
    EXPECT_NE(end.output.end.find(R"("exit_code":3)"), std::string::npos) << end.output.end;
}

} // namespace
} // namespace carom
