#pragma once

#include <filesystem>
#include <optional>

namespace carom {

/// How many processors' time the control groups of this process let it use, such as 1.5: the least that its
/// own group and those around it allow, as far as it sees them. Empty where none limits it. A container or a
/// service has such a limit (`docker run --cpus`, CPUQuota= of systemd); the processors that it sees are all
/// the same.
///
/// Read are, below `root`, proc/self/cgroup and proc/self/mountinfo (man 5 proc) and in the groups `cpu.max`
/// of version 2 (Documentation/admin-guide/cgroup-v2.rst of Linux) or `cpu.cfs_quota_us` and
/// `cpu.cfs_period_us` of version 1. What is missing or cannot be understood is no limit.
std::optional<double> read_cpu_quota(const std::filesystem::path& root = "/");

} // namespace carom
