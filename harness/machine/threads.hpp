#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace carom {

inline constexpr int most_threads = 1024;

/// How many processors' time the control groups of this process let it use, such as 1.5: the least that its
/// own group and those around it allow (`cpu.max`, Documentation/admin-guide/cgroup-v2.rst of Linux). Empty
/// where none limits it. A container or a service has such a limit (`docker run --cpus`, CPUQuota= of
/// systemd); the processors that it sees are all the same. What cannot be understood is no limit.
std::optional<double> read_cpu_quota(const std::filesystem::path& root = "/");

/// As many threads as OMP_NUM_THREADS says, or else one for each processor that may be used; no more than
/// OpenMP grants.
int default_threads();

/// How many processors this process may use at once: those of its affinity mask, and no more than whole ones
/// of its CPU quota; one at least.
int usable_processors();

/// How many of them are not taken by other programs now, at least one. Who is gone in a moment is not
/// counted. To be called while this process has one thread.
int free_processors();

/// How many threads of all programs run or are ready to, from the line of /proc/loadavg (man proc_loadavg);
/// empty if it is no such line.
std::optional<int> parse_running(const std::string& line);

/// From now on threads that wait for each other sleep at once, where the runtime can still be told, which is
/// LLVM's: for a machine whose processors other programs have. The other way it knows is to look out for
/// whole milliseconds. What the user has set (OMP_WAIT_POLICY, KMP_BLOCKTIME, KMP_LIBRARY) stays.
void wait_asleep();

/// From now on the process ends with one line and exit code 1 where memory runs out on several threads, which
/// no exception may leave; elsewhere std::bad_alloc is thrown, as ever.
void end_where_threads_run_out_of_memory();

/// Throws InputError if the address space that this process may have is too small for their stacks, or if
/// OpenMP grants fewer threads: nothing may be reported of threads that never ran.
void require_threads(int threads);

} // namespace carom
