#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace carom {

/// What a process has started, as its threads tell it: where the kernel has CONFIG_PROC_CHILDREN, as
/// distributions set it.
std::vector<pid_t> children_by_thread(pid_t parent);

/// The same by asking all processes for their parents, which every kernel tells.
std::vector<pid_t> children_by_parent(pid_t parent);

/// All that a process has started, and what that has started, as /proc lists them; without those that have
/// ended and are only to be waited for. What lost its parent counts if the process is its subreaper.
std::vector<pid_t> descendants_of(pid_t root);

/// Sends a signal to each. Returns those that it may not reach, since they run as another user.
std::vector<pid_t> send_signal(std::vector<pid_t> processes, int signal);

/// Whether a process stands still by a signal, or has ended.
bool stands_still(pid_t process);

/// The name of what a process runs, or its number.
std::string name_of(pid_t process);

/// Those of all of them, in a row.
std::string names_of(const std::vector<pid_t>& processes);

} // namespace carom
