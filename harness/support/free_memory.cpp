#include "harness/support/free_memory.hpp"

#include <algorithm>

#include <sys/resource.h>
#include <unistd.h>

#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/support/number_in_file.hpp"
#include "harness/support/own_cgroup.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;

/// Less is not asked for: most machines have as much, and it is known sooner by trying.
constexpr std::int64_t many_bytes = std::int64_t{256} << 20;

void keep_least(std::optional<std::int64_t>& least, std::optional<std::int64_t> other) {
    if (other) {
        least = std::min(*other, least.value_or(*other));
    }
}

/// What a group holds of files, which is given up when memory is short.
std::int64_t bytes_of_files(const fs::path& group) {
    const fs::path stat = group / "memory.stat";
    return number_in<std::int64_t>(stat, "\ninactive_file ").value_or(0) +
           number_in<std::int64_t>(stat, "\nactive_file ").value_or(0);
}

std::optional<std::int64_t> left_by_cgroups(const fs::path& root) {
    std::optional<std::int64_t> least;
    for (const fs::path& group : own_cgroups(root)) {
        const auto most = number_in<std::int64_t>(group / "memory.max"); // "max" is no number
        const auto now = number_in<std::int64_t>(group / "memory.current");
        if (most && now) {
            keep_least(least, std::max(*most - *now + bytes_of_files(group), std::int64_t{0}));
        }
    }
    return least;
}

std::string gibibytes(std::int64_t bytes) {
    return format("%.3g GiB", static_cast<double>(bytes) / (std::int64_t{1} << 30));
}

} // namespace

std::optional<std::int64_t> available_memory(const fs::path& root) {
    const auto kibibytes = number_in<std::int64_t>(root / "proc/meminfo", "MemAvailable:");
    return kibibytes ? std::optional(*kibibytes * 1024) : std::nullopt;
}

std::optional<std::int64_t> free_address_space(const fs::path& root) {
    rlimit limit{};
    // Its first number is all that is mapped.
    const auto pages = number_in<std::int64_t>(root / "proc/self/statm");
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || !pages) {
        return std::nullopt;
    }
    const std::int64_t mapped = *pages * sysconf(_SC_PAGESIZE);
    return std::max(static_cast<std::int64_t>(limit.rlim_cur) - mapped, std::int64_t{0});
}

std::optional<std::int64_t> free_memory(const fs::path& root) {
    std::optional<std::int64_t> least = available_memory(root);
    keep_least(least, left_by_cgroups(root));
    keep_least(least, free_address_space(root));
    return least;
}

void require_memory(std::int64_t bytes, const std::string& needed_for) {
    if (bytes < many_bytes) {
        return;
    }
    if (const auto left = free_memory(); left && *left < bytes) {
        throw InputError("out of memory: found " + gibibytes(*left) + " free, expected at least " +
                         gibibytes(bytes) + " for " + needed_for);
    }
}

} // namespace carom
