#pragma once

#include <sched.h>

namespace carom {

/// Lets this process run as soon as it has something to do, also where all processors are busy, if it may
/// (CAP_SYS_NICE): what it is late to notice would count as time of the programs that it times. Nothing that
/// it starts inherits that (sched(7)).
inline void run_at_once() {
    const sched_param least{.sched_priority = 1};
    sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &least);
}

} // namespace carom
