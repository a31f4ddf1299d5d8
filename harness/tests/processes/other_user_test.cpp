#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

#include <grp.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/processes/process.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

/// As an ordinary user, of whom a program becomes root that it may start but not end: how that went, in a
/// process of its own.
std::string told_by_an_ordinary_user(const ProcessCommand& command) {
    std::array<int, 2> line{};
    if (pipe(line.data()) != 0) {
        return "no pipe";
    }
    const pid_t child = fork();
    if (child == 0) {
        const bool is_ordinary = setgroups(0, nullptr) == 0 && setgid(65534) == 0 && setuid(65534) == 0;
        const double begin = process_seconds();
        Process process(command, nullptr);
        while (!process.has_ended()) {
            process.advance(0.05);
        }
        const std::string took = process_seconds() - begin < 3 ? "" : " after a long time";
        const std::string all =
            (is_ordinary ? process.facts()["unknown"].get<std::string>() : "still root") + took;
        _exit(write(line[1], all.data(), all.size()) < 0 ? 1 : 0);
    }
    close(line[1]);
    std::array<char, 256> buffer{};
    const auto count = std::max<ssize_t>(read(line[0], buffer.data(), buffer.size()), 0);
    close(line[0]);
    waitpid(child, nullptr, 0);
    return {buffer.data(), static_cast<std::size_t>(count)};
}

TEST(Process, ThatRunsAsAnotherUserIsLeftAndNamed) {
    const tests::TemporaryDirectory directory;
    const std::string becomes_root = directory / "becomes_root";
    struct statvfs place{};
    if (geteuid() != 0 || prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) != 0 ||
        !std::filesystem::exists("/usr/bin/setpriv") || statvfs((directory / "").c_str(), &place) != 0 ||
        (place.f_flag & ST_NOSUID) != 0) {
        GTEST_SKIP() << "only root can make such a program, and not everywhere";
    }
    std::filesystem::copy("/usr/bin/setpriv", becomes_root);
    chmod(becomes_root.c_str(), 04755);
    chmod((directory / "").c_str(), 0755);
    const ProcessCommand command{.words = {becomes_root, "--reuid=0", "sleep", "5"},
                                 .environment = {"PATH=/usr/bin:/bin"},
                                 .most_seconds = 0.4};
    EXPECT_EQ(told_by_an_ordinary_user(command), "it could not be ended: sleep runs as another user");
}

} // namespace
} // namespace carom
