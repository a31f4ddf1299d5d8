#pragma once

#include <string>
#include <string_view>

#include "harness/measure/profiler.hpp"

namespace carom {

/// The word of a phase in records and timelines.
std::string_view word(Phase phase);

/// Writes the profiler's spans in the Trace Event format (Google, "Trace Event Format", complete events),
/// which Perfetto and chrome://tracing open: one track a thread; on the master's, phases hold sweeps, which
/// hold loops and waits; chunks stand inside loops. Times are in microseconds, events of a track in the order
/// in which they begin, an outer one before those inside it. Throws InputError if the file cannot be written.
void write_timeline(const std::string& path, const Profiler& profiler, const std::string& title);

} // namespace carom
