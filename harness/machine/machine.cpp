#include "harness/machine/machine.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <omp.h>
#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "harness/machine/threads.hpp"
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

/// The CPUs that this process was given. Where threads are bound, the main thread has been moved to the first
/// of OpenMP's places before main began, and its own mask no longer tells. More CPUs than a cpu_set_t holds
/// are no error.
std::set<int> read_affinity() {
    std::set<int> cpus;
    std::array<cpu_set_t, 64> mask{};
    if (sched_getaffinity(0, sizeof mask, mask.data()) == 0) {
        for (std::size_t cpu = 0; cpu < 8 * sizeof mask; ++cpu) {
            if (CPU_ISSET_S(cpu, sizeof mask, mask.data())) {
                cpus.insert(static_cast<int>(cpu));
            }
        }
    }
    for (int place = 0; place < omp_get_num_places(); ++place) {
        std::vector<int> of_place(static_cast<std::size_t>(omp_get_place_num_procs(place)));
        omp_get_place_proc_ids(place, of_place.data());
        cpus.insert(of_place.begin(), of_place.end());
    }
    return cpus;
}

/// As 0-3,8.
std::string ranges_text(const std::set<int>& numbers) {
    std::string text;
    for (const int first : numbers) {
        if (numbers.contains(first - 1)) {
            continue;
        }
        int last = first;
        while (numbers.contains(last + 1)) {
            ++last;
        }
        text += (text.empty() ? "" : ",") + std::to_string(first) +
                (last > first ? "-" + std::to_string(last) : "");
    }
    return text;
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
    const std::set<int> affinity = read_affinity();
    return {{"host", kernel.nodename},
            {"cpu_model", info.model},
            {"cores", or_null(info.cores.empty() ? std::nullopt : std::optional(info.cores.size()))},
            {"hardware_threads", std::max(1L, sysconf(_SC_NPROCESSORS_ONLN))},
            {"affinity", ranges_text(affinity)},
            {"affinity_count", std::max<std::size_t>(affinity.size(), 1)},
            {"cpu_quota", or_null(read_cpu_quota())},
            {"memory_bytes", std::int64_t{sysconf(_SC_PHYS_PAGES)} * sysconf(_SC_PAGE_SIZE)},
            {"virtualised", info.hypervisor},
            {"governor", or_null(first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"))},
            {"operating_system", read_operating_system()}};
}

} // namespace carom
