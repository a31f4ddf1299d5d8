#include <chrono>
#include <csignal>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/processes/descendants.hpp"
#include "harness/tests/gone_processes.hpp"
#include "harness/tests/temporary_directory.hpp"

namespace carom {
namespace {

using Json = nlohmann::json;

/// `carom processes` in a process of its own, which is ended before its time.
class ProcessesKilled : public testing::Test {
  protected:
    /// Starts it with a program that writes the numbers of all its processes into a file, once it has three.
    std::vector<pid_t> start() {
        const std::string numbers = directory / "numbers";
        const std::string busy = "while :; do :; done";
        const std::string script = "setsid sh -c 'echo $$ >> " + numbers + "; " + busy +
                                   "' & sleep 600 & echo $! >> " + numbers + "; echo $$ >> " + numbers +
                                   "; " + busy;
        const Json plan{
            {"processes", {{{"command", {"/bin/sh", "-c", script}}}, {{"command", {"/bin/sh", "-c", busy}}}}},
            {"slice_seconds", 0.01}};
        const std::string file = directory.write("plan", plan.dump());
        carom = fork();
        if (carom == 0) {
            const int nothing = open("/dev/null", O_RDWR);
            dup2(open(file.c_str(), O_RDONLY), STDIN_FILENO);
            dup2(nothing, STDOUT_FILENO);
            dup2(nothing, STDERR_FILENO);
            execl(CAROM_PROGRAM, "carom", "processes", nullptr);
            _exit(127);
        }
        std::vector<pid_t> found;
        for (int wait = 0; wait < 1000 && found.size() < 3; ++wait) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            std::istringstream lines(tests::content_of(numbers));
            found.assign(std::istream_iterator<pid_t>(lines), {});
        }
        return found;
    }

    tests::TemporaryDirectory directory;
    pid_t carom = 0;
};

TEST_F(ProcessesKilled, LeavesNothingRunning) {
    for (const int signal : {SIGKILL, SIGTERM, SIGINT}) {
        directory.write("numbers", "");
        std::vector<pid_t> processes = start();
        ASSERT_EQ(processes.size(), 3);
        for (const pid_t keeper : descendants_of(carom)) {
            processes.push_back(keeper);
        }
        EXPECT_GE(processes.size(), 3 + 2);
        kill(carom, signal);
        waitpid(carom, nullptr, 0);
        for (const pid_t process : processes) {
            EXPECT_TRUE(tests::is_gone(process)) << "signal " << signal << ": " << name_of(process);
        }
    }
}

} // namespace
} // namespace carom
