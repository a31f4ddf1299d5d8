#include "harness/processes/kept_program.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/support/process_clock.hpp"

namespace carom {
namespace {

/// As execve wants it: pointers, and a null one at the end.
std::vector<char*> pointers_to(const std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (const std::string& text : texts) {
        pointers.push_back(const_cast<char*>(text.c_str()));
    }
    pointers.push_back(nullptr);
    return pointers;
}

/// The file that a first word names: itself if it has a slash, else the first on PATH that can be executed.
/// Unlike execvp this leaves it at that: a file that is no program is not given to a shell.
std::string program_of(const std::string& word) {
    if (word.find('/') != std::string::npos) {
        return word;
    }
    const char* const set = std::getenv("PATH");
    const std::string path = set != nullptr ? set : "/usr/local/bin:/usr/bin:/bin";
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find(':', begin), path.size());
        const std::string folder = path.substr(begin, end - begin);
        const std::string file = (folder.empty() ? "." : folder) + "/" + word;
        struct stat status{};
        if (stat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) && access(file.c_str(), X_OK) == 0) {
            return file;
        }
        begin = end + 1;
    }
    return "/nowhere/on/PATH/" + word;
}

/// All that the program needs, ready before the fork: nothing allocates between that and the program.
struct Prepared {
    std::string program;
    std::vector<char*> words;
    std::vector<char*> environment;
    const char* folder;
    int entrance;
    std::array<int, 3> streams; ///< that become its standard ones
    int go;
    pid_t keeper;
};

void restore_signals() {
    for (int signal = 1; signal < NSIG; ++signal) {
        std::signal(signal, SIG_DFL);
    }
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// Returns only if it cannot become the program; errno says why.
void become(const Prepared& prepared, Beginning& beginning) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    restore_signals();
    if (getppid() != prepared.keeper || (prepared.entrance >= 0 && write(prepared.entrance, "0", 1) != 1)) {
        return;
    }
    for (int stream = 0; stream < 3; ++stream) {
        if (dup2(prepared.streams[static_cast<std::size_t>(stream)], stream) < 0) {
            return;
        }
    }
    if (*prepared.folder != '\0' && chdir(prepared.folder) != 0) {
        return;
    }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    beginning.inherited_kilobytes = usage.ru_maxrss;
    char word = 0;
    if (read(prepared.go, &word, 1) != 1) {
        return;
    }
    beginning.at = process_seconds();
    execve(prepared.program.c_str(), prepared.words.data(), prepared.environment.data());
}

} // namespace

pid_t fork_program(const ProcessCommand& command, int entrance, Beginning& beginning, ProgramPipes& pipes) {
    constexpr int room = 1 << 20; // that a program that prints in bursts need not wait
    std::array<std::array<int, 2>, 4> made{};
    // The program inherits none of them, but for what is put in place of its standard streams.
    const bool all_made =
        std::ranges::all_of(made, [](auto& pipe) { return pipe2(pipe.data(), O_CLOEXEC) == 0; });
    const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (!all_made || nothing < 0) {
        return -1;
    }
    const auto [go, begun, output, error] = made;
    pipes = {.go = go[1], .begun = begun[0], .output = output[0], .error = error[0]};
    fcntl(pipes.output, F_SETPIPE_SZ, room);
    for (const int read_end : {pipes.output, pipes.error}) {
        fcntl(read_end, F_SETFL, O_NONBLOCK);
    }
    const Prepared prepared{.program = program_of(command.words.front()),
                            .words = pointers_to(command.words),
                            .environment = pointers_to(command.environment),
                            .folder = command.folder.c_str(),
                            .entrance = entrance,
                            .streams = {nothing, output[1], error[1]},
                            .go = go[0],
                            .keeper = getpid()};
    const pid_t child = fork();
    if (child == 0) {
        become(prepared, beginning);
        beginning.error = errno != 0 ? errno : ECHILD;
        _exit(127);
    }
    for (const int its_own : {nothing, go[0], begun[1], output[1], error[1]}) {
        close(its_own);
    }
    return child;
}

} // namespace carom
