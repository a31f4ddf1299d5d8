#include "harness/processes/cgroup.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/support/number_in_file.hpp"
#include "harness/support/own_cgroup.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;

/// What tells the processes of one name space from those of others, which have the same numbers.
std::string name_space() {
    struct stat status{};
    return stat("/proc/self/ns/pid", &status) == 0 ? std::to_string(status.st_ino) : "0";
}

bool write_into(const std::string& path, const char* text) {
    const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) {
        return false;
    }
    const auto length = static_cast<ssize_t>(std::char_traits<char>::length(text));
    const bool done = write(file, text, static_cast<std::size_t>(length)) == length;
    close(file);
    return done;
}

/// Ends what is left in a group and removes it, which works as soon as nobody is in it any more.
void remove_group(const std::string& path) {
    for (int attempt = 0; attempt < 200 && rmdir(path.c_str()) != 0 && errno == EBUSY; ++attempt) {
        write_into(path + "/cgroup.kill", "1");
        write_into(path + "/cgroup.freeze", "0");
        usleep(5000);
    }
}

/// Groups of runs that were killed together with what looked after them.
void remove_abandoned(const std::string& folder) {
    const std::string prefix = "carom-" + name_space() + "-";
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename();
        if (!name.starts_with(prefix)) {
            continue;
        }
        const std::string rest = name.substr(prefix.size());
        const auto owner = parse_number<pid_t>(rest.substr(0, rest.find('-')));
        if (owner && ::kill(*owner, 0) != 0 && errno == ESRCH) {
            remove_group(entry.path());
        }
    }
}

/// Whether a process may enter: who may make a group need not be allowed to move anybody into it.
bool can_be_entered(int entrance) {
    const pid_t child = fork();
    if (child == 0) {
        _exit(write(entrance, "0", 1) == 1 ? 0 : 1);
    }
    int status = 0;
    return child > 0 && (waitpid(child, &status, 0) != child || status == 0);
}

/// The system tells of a change of a group's events at most every ten milliseconds (cgroup_file_notify in the
/// kernel): who waits to be told takes a program for running long after it stands still. So the file is
/// asked.
constexpr unsigned microseconds_between_looks = 50;

bool is_frozen(int events) {
    std::array<char, 256> buffer{};
    const auto count = pread(events, buffer.data(), buffer.size() - 1, 0);
    return count > 0 && std::string(buffer.data()).find("frozen 1") != std::string::npos;
}

} // namespace

std::unique_ptr<Cgroup> Cgroup::make() {
    static int number = 0;
    static std::string entered; // to find out takes as long as a short program: a fork, and a move
    const std::vector<fs::path> groups = own_cgroups();
    if (groups.empty()) {
        return nullptr;
    }
    for (const fs::path& group : {groups.front(), groups.back()}) {
        const std::string folder = group.string();
        if (number == 0) {
            remove_abandoned(folder);
        }
        std::string path = folder + "/carom-" + name_space() + "-" + std::to_string(getpid()) + "-" +
                           std::to_string(++number);
        if (mkdir(path.c_str(), 0755) != 0) {
            continue;
        }
        const int entrance = open((path + "/cgroup.procs").c_str(), O_WRONLY | O_CLOEXEC);
        const int events = open((path + "/cgroup.events").c_str(), O_RDONLY | O_CLOEXEC);
        const bool complete = access((path + "/cgroup.freeze").c_str(), W_OK) == 0 &&
                              access((path + "/cgroup.kill").c_str(), W_OK) == 0;
        if (entrance >= 0 && events >= 0 && complete && (entered == folder || can_be_entered(entrance))) {
            entered = folder;
            return std::unique_ptr<Cgroup>(new Cgroup(std::move(path), entrance, events));
        }
        close(entrance);
        close(events);
        rmdir(path.c_str());
    }
    return nullptr;
}

Cgroup::Cgroup(std::string path, int entrance, int events)
    : path_(std::move(path)), entrance_(entrance), events_(events) {}

Cgroup::~Cgroup() {
    close(entrance_);
    close(events_);
    remove_group(path_);
}

bool Cgroup::stop(double most_seconds) const {
    const double until = process_seconds() + most_seconds;
    bool is_in_time = write_into(path_ + "/cgroup.freeze", "1");
    while (is_in_time && !is_frozen(events_)) {
        usleep(microseconds_between_looks);
        is_in_time = process_seconds() < until;
    }
    if (!is_in_time) {
        go_on();
    }
    return is_in_time;
}

void Cgroup::go_on() const { write_into(path_ + "/cgroup.freeze", "0"); }

void Cgroup::kill() const {
    write_into(path_ + "/cgroup.kill", "1");
    write_into(path_ + "/cgroup.freeze", "0");
}

void Cgroup::tell(nlohmann::ordered_json& facts, double waited_before) const {
    const auto user = number_in<double>(path_ + "/cpu.stat", "user_usec ");
    const auto system = number_in<double>(path_ + "/cpu.stat", "system_usec ");
    if (user && system) {
        facts["user_seconds"] = 1e-6 * *user;
        facts["system_seconds"] = 1e-6 * *system;
    }
    if (const auto waited = waited_seconds()) {
        facts["waited_seconds"] = std::max(0.0, *waited - waited_before);
    }
    if (const auto peak = number_in<double>(path_ + "/memory.peak")) {
        facts["peak_memory_bytes"] = static_cast<std::int64_t>(*peak);
        facts["memory_of"] = "all of its processes together, with the files that they hold in memory";
    }
}

std::optional<double> Cgroup::waited_seconds() const {
    const auto microseconds = number_in<double>(path_ + "/cpu.pressure", "full ", "total=");
    return microseconds ? std::optional(1e-6 * *microseconds) : std::nullopt;
}

} // namespace carom
