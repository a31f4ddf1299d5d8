#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <linux/perf_event.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/processes/event_counts.hpp"
#include "harness/processes/process.hpp"

namespace carom {
namespace {

/// What the kernel counts by itself wherever it lets anybody count.
const std::vector<CountedEvent> software_events{
    {"page_faults", PERF_TYPE_SOFTWARE, PERF_COUNT_SW_PAGE_FAULTS},
    {"no_such_event", PERF_TYPE_SOFTWARE, PERF_COUNT_SW_MAX + 1000}};

/// What was counted of a shell that runs this, from the moment at which it became the shell.
std::map<std::string, double> counted(const std::string& script) {
    std::array<int, 2> go{};
    EXPECT_EQ(pipe(go.data()), 0);
    const pid_t child = fork();
    if (child == 0) {
        char word = 0;
        const bool may_go = read(go[0], &word, 1) == 1;
        if (may_go) {
            execl("/bin/sh", "sh", "-c", script.c_str(), nullptr);
        }
        _exit(1);
    }
    const EventCounts counts(child, software_events);
    EXPECT_EQ(write(go[1], "g", 1), 1);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << script;
    close(go[0]);
    close(go[1]);
    return counts.read();
}

TEST(EventCounts, AreOfTheProgramWithAllThatItStarts) {
    const auto alone = counted(":");
    if (alone.empty()) {
        GTEST_SKIP() << "this machine lets nobody count (perf_event_paranoid, or a container's rule)";
    }
    const auto with_others = counted("for k in 1 2 3 4 5 6 7 8; do /bin/true; done");
    EXPECT_GT(alone.at("page_faults"), 0);
    EXPECT_GT(with_others.at("page_faults"), 3 * alone.at("page_faults"));
    EXPECT_FALSE(alone.contains("no_such_event"));
}

TEST(EventCounts, TellWhatTheSystemKeepsOfEachProcess) {
    const auto facts = run_undisturbed({.words = {"/bin/sh", "-c", "sleep 0.01; /bin/true"}});
    EXPECT_GT(facts["counted"]["minor_page_faults"], 0);
    EXPECT_GT(facts["counted"]["voluntary_context_switches"], 0);
    for (const auto& [name, amount] : facts["counted"].items()) {
        EXPECT_GE(amount, 0) << name;
    }
}

} // namespace
} // namespace carom
