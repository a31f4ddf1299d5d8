#pragma once

#include "harness/measure/measurement.hpp"

namespace carom {

/// What a process runs before it times anything of a measurement: every step checked, if that is asked for;
/// then the whole runs asked for, or, with none, two steps, since a process meets cold memory, sleeping
/// threads and a processor at rest. A violation is noted in the measurement, with the run that has it.
/// Returns the wall time of a unit of time as the last of these runs had it, in seconds.
double warm_up(Measurement& measurement);

} // namespace carom
