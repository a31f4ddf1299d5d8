#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace carom {

/// What this machine can and cannot measure, and why, as one object: machine, topology, frequency, affinity,
/// OpenMP runtime, counters by source, compilers and tools, Slurm and noise. What is not known is null. The
/// noise is probed for so many seconds. Nothing of the machine is changed.
nlohmann::ordered_json doctor_json(double noise_seconds);

/// How the program was built, and its OpenMP runtime: what a record says of that, at once.
nlohmann::ordered_json build_json();

/// The findings for a reader: lines of at most 80 columns.
std::string doctor_text(const nlohmann::ordered_json& findings);

} // namespace carom
