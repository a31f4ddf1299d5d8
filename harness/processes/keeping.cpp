#include "harness/processes/keeping.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/processes/cgroup.hpp"
#include "harness/processes/descendants.hpp"
#include "harness/processes/event_counts.hpp"
#include "harness/processes/kept_program.hpp"
#include "harness/processes/output_tail.hpp"
#include "harness/processes/priority.hpp"
#include "harness/processes/process_facts.hpp"
#include "harness/support/format.hpp"
#include "harness/support/json.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/support/text.hpp"
#include "harness/support/usage.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

/// Of every other descriptor its parent's copy alone is to count: as long as a second keeper held the line of
/// a first one, that would not close with its parent.
void close_all_but(std::vector<int> kept) {
    std::ranges::sort(kept);
    unsigned int next = 0;
    for (const int one : kept) {
        if (static_cast<unsigned int>(one) > next) {
            syscall(SYS_close_range, next, one - 1, 0);
        }
        next = static_cast<unsigned int>(one) + 1;
    }
    syscall(SYS_close_range, next, ~0U, 0);
}

/// The life of one program and of all that it starts.
class Keeping {
  public:
    Keeping(const ProcessCommand& command, const Cgroup* group, int line)
        : most_seconds_behind_(command.most_seconds_behind), group_(group), line_(line),
          output_(command.output_file), error_("") {
        sigset_t of_children;
        sigemptyset(&of_children);
        sigaddset(&of_children, SIGCHLD);
        sigprocmask(SIG_BLOCK, &of_children, nullptr);
        children_ = signalfd(-1, &of_children, SFD_NONBLOCK | SFD_CLOEXEC);
        void* const shared =
            mmap(nullptr, sizeof(Beginning), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        if (shared != MAP_FAILED) {
            beginning_ = new (shared) Beginning;
            program_ = fork_program(command, group != nullptr ? group->entrance() : -1, *beginning_, pipes_);
        }
        error_of_fork_ = program_ > 0 ? 0 : errno;
        if (program_ > 0) {
            events_ = std::make_unique<EventCounts>(program_);
        }
    }

    /// From the word to begin to the end of all of it.
    void keep() {
        tell("r");
        if (program_ > 0 && told() == 'g') {
            begin();
            while (!has_ended_ && left_.empty()) {
                wait();
            }
        }
        if (left_.empty()) {
            end_all();
        }
        read_from(pipes_.output, output_);
        read_from(pipes_.error, error_);
        tell(json_text(report(), -1));
        if (parent_is_gone_ && group_ != nullptr) {
            rmdir(group_->path().c_str());
        }
    }

  private:
    void tell(const std::string& text) const {
        std::size_t sent = 0;
        while (sent < text.size()) {
            const auto count = send(line_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
            if (count <= 0) {
                return;
            }
            sent += static_cast<std::size_t>(count);
        }
    }

    /// The next word of the parent, or 'k' if there is none any more.
    char told() {
        char word = 'k';
        parent_is_gone_ = read(line_, &word, 1) != 1;
        return parent_is_gone_ ? 'k' : word;
    }

    void begin() {
        char nothing = 0;
        [[maybe_unused]] const auto written = write(pipes_.go, "g", 1);
        close(pipes_.go);
        while (read(pipes_.begun, &nothing, 1) < 0 && errno == EINTR) {
        }
        if (group_ != nullptr) {
            waited_before_ = group_->waited_seconds().value_or(0);
        }
    }

    void wait() {
        std::array<pollfd, 4> waiting{{{.fd = children_, .events = POLLIN, .revents = 0},
                                       {.fd = line_, .events = POLLIN, .revents = 0},
                                       {.fd = pipes_.output, .events = POLLIN, .revents = 0},
                                       {.fd = pipes_.error, .events = POLLIN, .revents = 0}}};
        const bool is_behind = program_has_ended_ && most_seconds_behind_ < 1e9;
        if (poll(waiting.data(), waiting.size(), is_behind ? 100 : -1) < 0) {
            return;
        }
        if (is_behind && process_seconds() > program_ended_at_ + most_seconds_behind_) {
            end_all();
        }
        if (waiting[0].revents != 0) {
            reap();
        }
        if (waiting[1].revents != 0 && !has_ended_) {
            told();
            end_all();
        }
        if (waiting[2].revents != 0) {
            read_from(pipes_.output, output_);
        }
        if (waiting[3].revents != 0) {
            read_from(pipes_.error, error_);
        }
    }

    /// Takes leave of all that have ended; nobody left is the end of the program, also if it ended before.
    void reap() {
        std::array<signalfd_siginfo, 8> signals{};
        while (read(children_, signals.data(), sizeof signals) > 0) {
        }
        while (true) {
            int status = 0;
            rusage usage{};
            const pid_t ended = wait4(-1, &status, WNOHANG, &usage);
            if (ended < 0 && errno == ECHILD) {
                ended_at_ = process_seconds();
                has_ended_ = true;
            }
            if (ended <= 0) {
                return;
            }
            most_kilobytes_ = std::max(most_kilobytes_, usage.ru_maxrss);
            for (const auto& [name, amount] : counts_of(usage)) {
                Json& sum = name.ends_with("_seconds") ? facts_[name] : facts_["counted"][name];
                sum = (sum.is_null() ? 0 : sum.get<double>()) + amount;
            }
            if (ended == program_) {
                facts_["exit_code"] = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
                facts_["signal"] = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
                program_has_ended_ = true;
                program_ended_at_ = process_seconds();
            }
        }
    }

    /// Again and again, since some may be starting others. What cannot be ended is left: after ten seconds if
    /// it waits for a broken disk, at once if all that is there runs as another user.
    void end_all() {
        const double until = process_seconds() + 10;
        if (program_has_ended_ && !has_ended_) {
            facts_["went_on"] = names_of(descendants_of(getpid()));
        }
        while (!has_ended_ && program_ > 0 && process_seconds() < until) {
            const std::vector<pid_t> all = descendants_of(getpid());
            const std::vector<pid_t> of_others = send_signal(all, SIGKILL);
            left_ = names_of(all) + (of_others == all ? " runs as another user" : " waits for the system");
            if (group_ == nullptr && !all.empty() && of_others == all) {
                return;
            }
            if (group_ != nullptr) {
                group_->kill();
            }
            reap();
            usleep(has_ended_ ? 0 : 1000);
        }
    }

    /// What is there by now. At its end the pipe is closed, so that nobody waits for more.
    static void read_from(int& pipe, OutputTail& tail) {
        std::array<char, 65536> buffer;
        ssize_t count = 0;
        while (pipe >= 0 && (count = read(pipe, buffer.data(), buffer.size())) > 0) {
            tail.take({buffer.data(), static_cast<std::size_t>(count)});
        }
        if (pipe >= 0 && count == 0) {
            close(pipe);
            pipe = -1;
        }
    }

    /// A process begins with the mark of memory of whoever forked it (setrlimit's ru_maxrss survives execve),
    /// so that less than that, or hardly more, cannot be seen.
    void tell_memory() {
        constexpr long hardly_more = 256;
        const long seen = beginning_->inherited_kilobytes + hardly_more;
        if (most_kilobytes_ > seen) {
            facts_["peak_memory_bytes"] = std::int64_t{most_kilobytes_} * 1024;
            facts_["memory_of"] = "the largest of its processes";
        } else {
            facts_["memory_of"] = format("no more than %.1f MB, which a process has from whoever starts it",
                                         1024e-6 * static_cast<double>(seen));
        }
    }

    Json facts() {
        if (const int error = program_ > 0 ? beginning_->error : error_of_fork_; error != 0) {
            Json none = no_facts();
            none["not_started"] = std::strerror(error);
            return none;
        }
        if (!has_ended_) {
            facts_["unknown"] = "it could not be ended: " + left_;
        } else if (!program_has_ended_) {
            facts_["unknown"] = "the system does not tell";
        }
        if (has_ended_) {
            facts_["counted"].update(Json(events_->read()));
        }
        if (program_has_ended_) {
            facts_["seconds_left_behind"] = ended_at_ - program_ended_at_;
        }
        facts_["output_bytes"] = output_.bytes();
        facts_["error_bytes"] = error_.bytes();
        facts_["output_end"] = output_.end();
        facts_["error_end"] = last_line(error_.end());
        tell_memory();
        if (group_ != nullptr) {
            group_->tell(facts_, waited_before_);
        }
        return facts_;
    }

    Json report() {
        return {
            {"facts", facts()}, {"began_at", program_ > 0 ? beginning_->at : 0.0}, {"ended_at", ended_at_}};
    }

    double most_seconds_behind_;
    const Cgroup* group_;
    int line_;
    int children_ = -1; ///< readable when one of them has ended
    Beginning* beginning_ = nullptr;
    ProgramPipes pipes_;
    pid_t program_ = -1;
    int error_of_fork_ = 0;
    bool parent_is_gone_ = false;
    OutputTail output_;
    OutputTail error_;
    Json facts_ = no_facts();
    bool program_has_ended_ = false;
    bool has_ended_ = false; ///< it and all that it started
    double program_ended_at_ = 0;
    double ended_at_ = 0;
    double waited_before_ = 0; ///< for a processor, before it became the program
    long most_kilobytes_ = 0;
    std::unique_ptr<EventCounts> events_;
    std::string left_; ///< what could not be ended so far, and why
};

} // namespace

void keep(const ProcessCommand& command, const Cgroup* group, int line) {
    run_at_once();
    setsid();
    prctl(PR_SET_NAME, "carom-keeper");
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    std::signal(SIGCHLD, SIG_DFL);
    std::signal(SIGPIPE, SIG_IGN); // the program may end before it is told to begin
    std::vector<int> kept{line};
    if (group != nullptr) {
        kept.push_back(group->entrance());
    }
    close_all_but(kept);
    // Its standard streams are closed with the rest: whatever opens next would take their numbers.
    for (int stream = 0; stream < 3; ++stream) {
        open("/dev/null", O_RDWR | O_CLOEXEC);
    }
    Keeping(command, group, line).keep();
    _exit(0);
}

} // namespace carom
