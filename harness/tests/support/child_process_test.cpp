#include <algorithm>
#include <csignal>
#include <string>

#include <gtest/gtest.h>

#include "harness/support/child_process.hpp"
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

TEST(RunChild, TellsHowItEnded) {
    EXPECT_TRUE(run_child({"true"}).succeeded());
    EXPECT_EQ(run_child({"sh", "-c", "exit 3"}).exit_code, 3);
    EXPECT_FALSE(run_child({"sh", "-c", "exit 3"}).succeeded());
    EXPECT_EQ(run_child({"sh", "-c", "kill -KILL $$"}).signal, SIGKILL);
    EXPECT_FALSE(run_child({"carom-is-no-such-program"}).started);
    EXPECT_FALSE(run_child({"carom-is-no-such-program"}).succeeded());
}

TEST(RunChild, TakesNoEndThatIsNotKnownForASuccess) {
    const IgnoredChildren ignored;
    for (const char* script : {"exit 0", "exit 3"}) {
        const ChildEnd end = run_child({"sh", "-c", script});
        EXPECT_TRUE(end.started);
        EXPECT_FALSE(end.is_known);
        EXPECT_FALSE(end.succeeded()) << script;
    }
}

TEST(RunChild, KeepsBothEndsOfALongOutput) {
    const std::string script = "echo first; yes | head -c 3000000; echo; echo last";
    const ChildEnd end = run_child({"sh", "-c", script});
    EXPECT_TRUE(end.succeeded());
    EXPECT_TRUE(end.output.starts_with("first\ny\ny\n"));
    EXPECT_EQ(last_line(end.output), "last");
    EXPECT_LE(end.output.size(), 2 * kept_output + 5000);
    const ChildEnd whole = run_child({"sh", "-c", "yes | head -c 100000"});
    EXPECT_EQ(std::ranges::count(whole.output, 'y'), 50000);
    EXPECT_EQ(whole.output.size(), 100000U);
}

TEST(Program, KnowsHowItsChildrenEndWhoeverStartedIt) {
    const tests::TemporaryDirectory directory;
    const std::string processes =
        directory.write("processes.json", R"([{"command": ["sh", "-c", "exit 3"], "record": ")" +
                                              directory / "record.json" + R"("}])");
    const ChildEnd end =
        run_child({"sh", "-c", R"(trap '' CHLD; exec "$0" "$@")", CAROM_PROGRAM, "processes", processes});
    EXPECT_EQ(end.exit_code, 1);
    EXPECT_NE(end.output.find("exit code 3"), std::string::npos) << end.output;
}

} // namespace
} // namespace carom
