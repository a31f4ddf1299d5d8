#pragma once

#include "harness/measure/measurement.hpp"

namespace carom {

/// What a process runs before it times anything of a measurement: every step checked, if that is asked for;
/// then the whole runs asked for, or, with none, two steps, since a process meets cold memory, sleeping
/// threads and a processor at rest. What is not checked runs on `simulation`, which is to be timed, so that
/// its memory has been touched and its lists have grown; it then stands anywhere. A violation is noted in the
/// measurement, with the run that has it. Returns the wall time of a unit of time as the last of these runs
/// had it, in seconds.
double warm_up(Measurement& measurement, Simulation& simulation);

} // namespace carom
