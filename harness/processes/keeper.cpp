#include "harness/processes/keeper.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <set>
#include <string>

#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/processes/descendants.hpp"
#include "harness/processes/keeping.hpp"
#include "harness/processes/kept_program.hpp"
#include "harness/support/errors.hpp"

namespace carom {
namespace {

constexpr double most_seconds_to_start = 20;
constexpr double most_seconds_to_end = 15; ///< a keeper takes ten at most

/// The keepers of this process: its other children are what keepers have left behind that were killed.
std::set<pid_t>& keepers() {
    static std::set<pid_t> all;
    return all;
}

/// Of a keeper that somebody killed, what it kept falls to this process.
void end_orphans() {
    for (const pid_t one : descendants_of(getpid())) {
        if (!keepers().contains(one)) {
            bool is_kept = false;
            for (const pid_t keeper : keepers()) {
                const auto kept = descendants_of(keeper);
                is_kept = is_kept || std::ranges::find(kept, one) != kept.end();
            }
            if (!is_kept) {
                kill(one, SIGKILL);
                waitpid(one, nullptr, 0);
            }
        }
    }
}

} // namespace

Keeper::Keeper(const ProcessCommand& command, const Cgroup* group) {
    std::array<int, 2> line{};
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    std::signal(SIGCHLD, SIG_DFL);
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, line.data()) != 0) {
        throw InputError(std::string("no socket can be made: ") + std::strerror(errno));
    }
    process_ = fork();
    if (process_ == 0) {
        keep(command, group, line[1]);
    }
    const int reason = errno;
    close(line[1]);
    line_ = line[0];
    if (process_ < 0) {
        close(line_);
        throw InputError(std::string("no process can be started: ") + std::strerror(reason));
    }
    keepers().insert(process_);
    char ready = 0;
    if (!await_end(most_seconds_to_start) || read(line_, &ready, 1) != 1) {
        close(line_);
        kill(process_, SIGKILL);
        throw InputError(command.words.front() + ": nothing could be started that looks after it");
    }
}

Keeper::~Keeper() {
    if (line_ >= 0) {
        shutdown(line_, SHUT_WR);
        report();
    }
}

void Keeper::tell(char word) const { [[maybe_unused]] const auto sent = send(line_, &word, 1, MSG_NOSIGNAL); }

bool Keeper::await_end(double seconds) const {
    const double until = steady_seconds() + std::min(seconds, 1e6);
    pollfd waiting{.fd = line_, .events = POLLIN, .revents = 0};
    while (true) {
        const double left = std::max(0.0, until - steady_seconds());
        const auto whole = static_cast<std::time_t>(left);
        const timespec time{.tv_sec = whole,
                            .tv_nsec = static_cast<long>((left - static_cast<double>(whole)) * 1e9)};
        if (ppoll(&waiting, 1, &time, nullptr) > 0) {
            return true;
        }
        if (steady_seconds() >= until) {
            return false;
        }
    }
}

nlohmann::ordered_json Keeper::report() {
    std::string text;
    std::array<char, 65536> buffer;
    ssize_t count = 0;
    while (await_end(most_seconds_to_end) &&
           ((count = read(line_, buffer.data(), buffer.size())) > 0 || (count < 0 && errno == EINTR))) {
        text.append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
    close(line_);
    line_ = -1;
    kill(process_, SIGKILL);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
    keepers().erase(process_);
    const auto json = nlohmann::ordered_json::parse(text, nullptr, false);
    if (!json.is_object()) {
        end_orphans();
        return nullptr;
    }
    return json;
}

} // namespace carom
