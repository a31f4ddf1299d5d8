#include "harness/measure/process.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <random>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/support/errors.hpp"
#include "harness/support/stopwatch.hpp"

namespace carom {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    pointers.reserve(texts.size() + 1);
    for (std::string& text : texts) {
        pointers.push_back(text.data());
    }
    pointers.push_back(nullptr);
    return pointers;
}

/// What stands between fork and exec, so nothing that allocates or locks. Returns only if that fails.
void become(char* const* words, char* const* environment, const char* folder, int output, int error,
            pid_t parent) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int nothing = open("/dev/null", O_RDONLY);
    const bool is_orphan = getppid() != parent;
    if (is_orphan || nothing < 0 || dup2(nothing, STDIN_FILENO) < 0 || dup2(output, STDOUT_FILENO) < 0 ||
        dup2(error, STDERR_FILENO) < 0 || (*folder != '\0' && chdir(folder) != 0)) {
        return;
    }
    std::signal(SIGXFSZ, SIG_DFL);
    execvpe(words[0], words, environment);
}

std::string content_of(std::FILE* file) {
    std::string text;
    std::array<char, 65536> buffer;
    std::rewind(file);
    while (const auto count = std::fread(buffer.data(), 1, buffer.size(), file)) {
        text.append(buffer.data(), count);
    }
    return text;
}

std::FILE* temporary_file() {
    std::FILE* file = std::tmpfile();
    if (file == nullptr) {
        throw InputError(std::string("no temporary file can be made: ") + std::strerror(errno));
    }
    fcntl(fileno(file), F_SETFD, FD_CLOEXEC);
    return file;
}

double seconds_of(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

} // namespace

double ProcessEnd::wall_seconds() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }

Process::Process(ProcessCommand command)
    : command_(std::move(command)), output_(temporary_file()), error_(temporary_file()) {}

Process::~Process() {
    if (child_ != 0 && !has_ended_) {
        kill_group();
        waitpid(child_, nullptr, 0);
    }
    std::fclose(output_);
    std::fclose(error_);
    if (ends_ >= 0) {
        close(ends_);
    }
}

void Process::advance(double seconds) {
    const double left = command_.most_seconds - end_.wall_seconds();
    const auto before = Clock::now();
    if (child_ == 0) {
        start();
    } else {
        kill(-child_, SIGCONT);
    }
    if (!has_ended_) {
        await_end(std::min(seconds, left));
    }
    if (!has_ended_) {
        stop();
    }
    end_.seconds.push_back(seconds_since(before));
    if (!has_ended_ && end_.wall_seconds() >= command_.most_seconds) {
        end_.out_of_time = true;
        kill_group();
        take_leave();
    }
}

void Process::start() {
    std::array<int, 2> report{};
    if (pipe2(report.data(), O_CLOEXEC) != 0) {
        throw InputError(std::string("no pipe can be made: ") + std::strerror(errno));
    }
    child_ = spawn(report[1]);
    int reason = errno;
    close(report[1]);
    const bool refused = child_ < 0 || read(report[0], &reason, sizeof reason) == sizeof reason;
    close(report[0]);
    if (refused) {
        if (child_ > 0) {
            waitpid(child_, nullptr, 0);
        }
        has_ended_ = true;
        end_.not_started = std::strerror(reason);
        return;
    }
    ends_ = static_cast<int>(syscall(SYS_pidfd_open, child_, 0));
    if (ends_ < 0) {
        throw InputError(std::string("pidfd_open: ") + std::strerror(errno) +
                         "; expected Linux 5.3 or newer");
    }
}

/// The new process, or -1. Why it cannot become the program it writes into `report`, which closes if it can.
pid_t Process::spawn(int report) {
    std::vector<char*> words = pointers_to(command_.words);
    std::vector<char*> environment = pointers_to(command_.environment);
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child == 0) {
        become(words.data(), environment.data(), command_.folder.c_str(), fileno(output_), fileno(error_),
               parent);
        const int reason = errno;
        const auto written = write(report, &reason, sizeof reason);
        _exit(written == sizeof reason ? 127 : 126);
    }
    return child;
}

void Process::await_end(double seconds) {
    const auto until = Clock::now() + std::chrono::duration<double>(std::min(seconds, 1e6));
    pollfd waiting{.fd = ends_, .events = POLLIN, .revents = 0};
    while (true) {
        const std::chrono::duration<double> left = until - Clock::now();
        if (left.count() <= 0) {
            return;
        }
        const auto whole = static_cast<std::time_t>(left.count());
        const timespec time{.tv_sec = whole,
                            .tv_nsec = static_cast<long>((left.count() - static_cast<double>(whole)) * 1e9)};
        if (ppoll(&waiting, 1, &time, nullptr) > 0) {
            take_leave();
            return;
        }
    }
}

void Process::stop() {
    if (kill(-child_, SIGSTOP) != 0) {
        kill(child_, SIGSTOP);
    }
    siginfo_t how{};
    // Whether it stands still, or ended before it could.
    while (waitid(P_PID, static_cast<id_t>(child_), &how, WSTOPPED | WEXITED | WNOWAIT) < 0 &&
           errno == EINTR) {
    }
    if (how.si_code == CLD_STOPPED || how.si_code == CLD_TRAPPED) {
        waitid(P_PID, static_cast<id_t>(child_), &how, WSTOPPED);
    } else {
        take_leave();
    }
}

/// What is left of its group goes with it: children that nobody waited for. As long as it is not waited for,
/// nobody else can have its number.
void Process::take_leave() {
    siginfo_t how{};
    while (waitid(P_PID, static_cast<id_t>(child_), &how, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
    }
    kill_group();
    int status = 0;
    rusage usage{};
    while (wait4(child_, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    has_ended_ = true;
    end_.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    end_.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    end_.user_seconds = seconds_of(usage.ru_utime);
    end_.system_seconds = seconds_of(usage.ru_stime);
    end_.peak_memory_bytes = std::int64_t{usage.ru_maxrss} * 1024;
}

void Process::kill_group() { kill(-child_, SIGKILL); }

ProcessEnd Process::end() const {
    ProcessEnd end = end_;
    end.output = content_of(output_);
    end.error = content_of(error_);
    if (std::ferror(output_) != 0 || std::ferror(error_) != 0) {
        throw InputError(command_.words.front() + ": what it printed cannot be read back");
    }
    return end;
}

void take_slices(std::vector<Process*> processes, double slice_seconds, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    while (!processes.empty()) {
        std::ranges::shuffle(processes, random);
        for (Process* const process : processes) {
            process->advance(processes.size() == 1 ? 1e9 : slice_seconds);
        }
        std::erase_if(processes, [](const Process* process) { return process->has_ended(); });
    }
}

} // namespace carom
