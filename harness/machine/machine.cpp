#include "harness/machine/machine.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <omp.h>
#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "harness/machine/cpu_quota.hpp"
#include "harness/support/json.hpp"

namespace carom {
namespace {

struct CpuInfo {
    std::string model = "unknown";
    std::set<std::pair<std::string, std::string>> cores; ///< socket and core
    bool hypervisor = false;
};

CpuInfo read_cpu_info() {
    CpuInfo info;
    std::ifstream file("/proc/cpuinfo");
    std::string socket;
    for (std::string line; std::getline(file, line);) {
        const auto colon = line.find(':');
        const std::string value =
            colon == std::string::npos || colon + 2 > line.size() ? "" : line.substr(colon + 2);
        if (line.starts_with("model name") || (line.starts_with("CPU part") && info.model == "unknown")) {
            info.model = value;
        } else if (line.starts_with("physical id")) {
            socket = value;
        } else if (line.starts_with("core id")) {
            info.cores.emplace(socket, value);
        } else if (line.starts_with("flags")) {
            info.hypervisor = (value + " ").find(" hypervisor ") != std::string::npos;
        }
    }
    return info;
}

std::string read_operating_system() {
    std::string distribution = "unknown distribution";
    std::ifstream file("/etc/os-release");
    constexpr std::string_view key = "PRETTY_NAME=\"";
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with(key)) {
            distribution = line.substr(key.size(), line.size() - key.size() - 1);
        }
    }
    utsname kernel{};
    uname(&kernel);
    return distribution + ", " + kernel.sysname + " " + kernel.release + " " + kernel.machine;
}

constexpr int most_cpus = 1 << 16;

/// Adds the CPUs of OpenMP's places. Where threads are bound, the main thread has been moved to the first
/// place before main began, and its own mask no longer tells what the process was given.
void add_places(cpu_set_t* set, std::size_t bytes) {
    for (int place = 0; place < omp_get_num_places(); ++place) {
        std::vector<int> cpus(static_cast<std::size_t>(omp_get_place_num_procs(place)));
        omp_get_place_proc_ids(place, cpus.data());
        for (const int cpu : cpus) {
            if (cpu >= 0 && cpu < most_cpus) {
                CPU_SET_S(static_cast<std::size_t>(cpu), bytes, set);
            }
        }
    }
}

/// The CPUs as 0-3,8, and how many they are. The set is as large as the system needs: more CPUs than
/// cpu_set_t holds are no error.
std::pair<std::string, int> read_affinity() {
    std::pair<std::string, int> found{"", 1};
    cpu_set_t* set = CPU_ALLOC(most_cpus);
    const std::size_t bytes = CPU_ALLOC_SIZE(most_cpus);
    CPU_ZERO_S(bytes, set);
    if (sched_getaffinity(0, bytes, set) == 0) {
        add_places(set, bytes);
        found.second = CPU_COUNT_S(bytes, set);
        std::ostringstream ranges;
        int first = most_cpus;
        for (int cpu = 0; cpu < most_cpus; ++cpu) {
            if (!CPU_ISSET_S(static_cast<std::size_t>(cpu), bytes, set)) {
                continue;
            }
            first = std::min(first, cpu);
            int last = cpu;
            while (last + 1 < most_cpus && CPU_ISSET_S(static_cast<std::size_t>(last + 1), bytes, set)) {
                ++last;
            }
            ranges << (cpu > first ? "," : "") << cpu;
            if (last > cpu) {
                ranges << '-' << last;
            }
            cpu = last;
        }
        found.first = ranges.str();
    }
    CPU_FREE(set);
    return found;
}

} // namespace

std::optional<std::string> first_line(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    if (!std::getline(file, line)) {
        return std::nullopt;
    }
    return line;
}

nlohmann::ordered_json read_machine() {
    utsname kernel{};
    uname(&kernel);
    const CpuInfo info = read_cpu_info();
    const auto [affinity, affinity_count] = read_affinity();
    return {{"host", kernel.nodename},
            {"cpu_model", info.model},
            {"cores", or_null(info.cores.empty() ? std::nullopt : std::optional(info.cores.size()))},
            {"hardware_threads", std::max(1L, sysconf(_SC_NPROCESSORS_ONLN))},
            {"affinity", affinity},
            {"affinity_count", affinity_count},
            {"cpu_quota", or_null(read_cpu_quota())},
            {"memory_bytes", std::int64_t{sysconf(_SC_PHYS_PAGES)} * sysconf(_SC_PAGE_SIZE)},
            {"virtualised", info.hypervisor},
            {"governor", or_null(first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"))},
            {"operating_system", read_operating_system()}};
}

} // namespace carom
