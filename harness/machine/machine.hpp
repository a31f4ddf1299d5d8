#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace carom {

/// What the operating system tells of the machine without any right or library.
struct Machine {
    std::string host;
    std::string cpu_model;
    std::optional<int> cores; ///< physical; empty if the system does not tell
    int hardware_threads = 1;
    std::string affinity; ///< the CPUs this process may run on, as 0-3,8
    int affinity_count = 1;
    std::optional<double> cpu_quota; ///< processors' time that control groups grant; empty if they limit none
    bool has_unread_cpu_quota = false; ///< those that grant processors are of version 1, which is not read
    std::int64_t memory_bytes = 0;
    bool virtualised = false;            ///< the CPU shows the hypervisor flag
    std::optional<std::string> governor; ///< of CPU frequency
    std::string operating_system;        ///< distribution, kernel and its release
};

/// Reads it now; nothing is changed.
Machine read_machine();

/// The first line of a file of the system, or nothing if it cannot be read.
std::optional<std::string> first_line(const std::string& path);

} // namespace carom
