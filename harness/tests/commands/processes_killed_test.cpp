#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/processes/descendants.hpp"
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
            found = numbers_in(tests::content_of(numbers));
        }
        return found;
    }

    static std::vector<pid_t> numbers_in(const std::string& text) {
        std::vector<pid_t> numbers;
        std::size_t begin = 0;
        for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
            numbers.push_back(std::stoi(text.substr(begin, end - begin)));
        }
        return numbers;
    }

    /// What of them is still there after some seconds.
    static std::vector<pid_t> left_of(std::vector<pid_t> processes) {
        for (int wait = 0; wait < 500 && !processes.empty(); ++wait) {
            std::erase_if(processes, [](pid_t process) {
                const std::string stat = tests::content_of("/proc/" + std::to_string(process) + "/stat");
                return stat.empty() || stat.find(") Z") != std::string::npos;
            });
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return processes;
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
        const auto left = left_of(processes);
        EXPECT_TRUE(left.empty()) << "signal " << signal << ": " << name_of(left.front());
    }
}

} // namespace
} // namespace carom
