#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace carom {

/// The hierarchy of control groups, at one place where it is mounted.
struct CgroupMount {
    std::filesystem::path place;
    std::filesystem::path top; ///< the group that is seen there
};

/// All of them, of version 2, as proc/self/mountinfo below `root` tells.
std::vector<CgroupMount> cgroup_mounts(const std::filesystem::path& root = "/");

/// How many processors' time the control groups of this process let it use, such as 1.5: the least that its
/// own group and those around it allow, as far as it sees them. Empty where none limits it. A container or a
/// service has such a limit (`docker run --cpus`, CPUQuota= of systemd); the processors that it sees are all
/// the same.
///
/// Read are, below `root`, proc/self/cgroup and proc/self/mountinfo (man 5 proc) and in the groups `cpu.max`
/// of version 2 (Documentation/admin-guide/cgroup-v2.rst of Linux). What is missing or cannot be understood
/// is no limit.
std::optional<double> read_cpu_quota(const std::filesystem::path& root = "/");

/// Whether processors are granted by control groups of version 1, whose limits are not read.
bool has_unread_cpu_quota(const std::filesystem::path& root = "/");

} // namespace carom
