#pragma once

#include <sys/types.h>

#include "harness/processes/cgroup.hpp"
#include "harness/processes/process_command.hpp"

namespace carom {

/// What a keeper does, from its fork to its end. It tells its parent over `line`: a byte once the program is
/// ready to begin, and how it ended, as JSON, before it closes. It is told: g, let it begin; k, end all. If
/// the line closes it ends all as well. Never returns.
[[noreturn]] void keep(const ProcessCommand& command, const Cgroup* group, int line);

} // namespace carom
