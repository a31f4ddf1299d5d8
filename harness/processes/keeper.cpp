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
#include "harness/support/errors.hpp"
#include "harness/support/process_clock.hpp"

namespace carom {
namespace {

constexpr double most_seconds_to_start = 20;
constexpr double most_seconds_to_end = 15; ///< a keeper takes ten at most

/// The keepers of this process: its other children are what keepers have left behind that were killed.
std::set<pid_t>& keepers() {
    static std::set<pid_t> all;
    return all;
}

/// The descendants of this process that no keeper has.
std::vector<pid_t> orphans() {
    std::set<pid_t> kept = keepers();
    for (const pid_t keeper : keepers()) {
        const std::vector<pid_t> its = descendants_of(keeper);
        kept.insert(its.begin(), its.end());
    }
    std::vector<pid_t> found = descendants_of(getpid());
    std::erase_if(found, [&kept](pid_t one) { return kept.contains(one); });
    return found;
}

/// Of a keeper that somebody killed, what it kept falls to this process: one after the other, as their own
/// parents end, so that a single look may miss some.
void end_orphans() {
    constexpr int looks_without_any = 5;
    int seen_none = 0;
    for (int look = 0; look < 1000 && seen_none < looks_without_any; ++look) {
        const std::vector<pid_t> found = orphans();
        seen_none = found.empty() ? seen_none + 1 : 0;
        for (const pid_t one : found) {
            kill(one, SIGKILL);
        }
        // The ends of keepers are awaited by number; those of others nobody waits for.
        while (waitpid(-1, nullptr, WNOHANG) > 0) {
        }
        usleep(1000);
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
        throw InputError(command.words.front() + ": the process that is to watch over it did not start");
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
    const double until = process_seconds() + std::min(seconds, 1e6);
    pollfd waiting{.fd = line_, .events = POLLIN, .revents = 0};
    while (true) {
        const double left = std::max(0.0, until - process_seconds());
        const auto whole = static_cast<std::time_t>(left);
        const timespec time{.tv_sec = whole,
                            .tv_nsec = static_cast<long>((left - static_cast<double>(whole)) * 1e9)};
        if (ppoll(&waiting, 1, &time, nullptr) > 0) {
            return true;
        }
        if (process_seconds() >= until) {
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
