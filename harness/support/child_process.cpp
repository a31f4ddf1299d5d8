#include "harness/support/child_process.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <string_view>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/support/errors.hpp"

namespace carom {
namespace {

/// What the child finds as its standard streams.
class Redirections {
  public:
    explicit Redirections(int output) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, output, STDERR_FILENO);
    }
    ~Redirections() { posix_spawn_file_actions_destroy(&actions_); }
    Redirections(const Redirections&) = delete;
    Redirections& operator=(const Redirections&) = delete;

    const posix_spawn_file_actions_t* get() const { return &actions_; }

  private:
    posix_spawn_file_actions_t actions_{};
};

/// All that comes, but of much only its beginning and its end.
std::string read_ends(int descriptor) {
    std::string beginning;
    std::string rest;
    bool is_cut = false;
    std::array<char, 4096> buffer;
    while (true) {
        const auto count = read(descriptor, buffer.data(), buffer.size());
        if (count > 0) {
            std::string& text = beginning.size() < kept_output ? beginning : rest;
            text.append(buffer.data(), static_cast<std::size_t>(count));
        } else if (count == 0 || errno != EINTR) {
            break;
        }
        if (rest.size() > 2 * kept_output) {
            rest.erase(0, rest.size() - kept_output);
            is_cut = true;
        }
    }
    if (is_cut || rest.size() > kept_output) {
        return beginning + '\n' + rest.substr(rest.size() - kept_output);
    }
    return beginning + rest;
}

[[noreturn]] void refuse(const std::string& program, int error) {
    throw InputError(program + ": cannot be started (" + std::strerror(error) + ")");
}

} // namespace

ChildEnd run_child(const std::vector<std::string>& command) {
    std::vector<std::string> texts = command;
    std::vector<char*> arguments;
    arguments.reserve(texts.size() + 1);
    for (std::string& text : texts) {
        arguments.push_back(text.data());
    }
    arguments.push_back(nullptr);
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
        refuse(command.front(), errno);
    }
    const Redirections redirections(ends[1]);
    pid_t child = 0;
    const int error =
        posix_spawnp(&child, arguments.front(), redirections.get(), nullptr, arguments.data(), environ);
    close(ends[1]);
    ChildEnd end;
    end.started = error == 0;
    if (end.started) {
        end.output = read_ends(ends[0]);
    }
    close(ends[0]);
    if (error == EAGAIN || error == ENOMEM) {
        refuse(command.front(), error);
    }
    int status = 0;
    pid_t waited = 0;
    while (end.started && (waited = waitpid(child, &status, 0)) < 0 && errno == EINTR) {
    }
    // Where SIGCHLD is ignored nobody keeps how a child ended.
    end.is_known = waited == child && end.started;
    end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    return end;
}

std::string last_line(const std::string& text) {
    std::istringstream lines(text);
    std::string last;
    for (std::string line; std::getline(lines, line);) {
        if (line.find_first_not_of(" \t\r") != std::string::npos) {
            last = line;
        }
    }
    return last;
}

} // namespace carom
