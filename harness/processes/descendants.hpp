#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace carom {

/// All that a process has started, and what that has started, as /proc lists them; without those that have
/// ended and are only to be waited for. What lost its parent counts if the process is its subreaper.
std::vector<pid_t> descendants_of(pid_t root);

/// Whether a process stands still by a signal, or has ended.
bool stands_still(pid_t process);

/// The name of what a process runs, or its number.
std::string name_of(pid_t process);

} // namespace carom
