#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/counters/access.hpp"
#include "harness/counters/counters.hpp"
#include "harness/machine/machine.hpp"
#include "harness/machine/noise.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/machine/topology.hpp"

namespace carom {

/// A source of counters: the events that it counts, in how many runs, and those that it cannot count and why.
struct CounterSource {
    std::string name; ///< papi-hardware, papi-software, rusage or cachegrind
    std::vector<std::string> events = {};
    int runs = 0;
    std::vector<CounterValue> missing = {};
};

/// A compiler or a profiler.
struct Tool {
    std::string name;
    std::string package; ///< which has it
    std::string version; ///< empty if it is not on PATH
};

/// What this machine can and cannot measure, and why. What is not known is empty.
struct Findings {
    Machine machine;
    std::optional<std::int64_t> memory_available_bytes;
    Topology topology;
    std::optional<bool> turbo; ///< whether the CPU may run above its nominal frequency
    int usable_processors = 1;
    int threads_by_default = 1;
    OpenMp openmp;
    std::string papi; ///< its version
    PerfAccess perf;
    std::vector<CounterSource> counters;
    std::vector<Tool> tools;
    std::string slurm_version;                    ///< empty if srun is not on PATH
    std::map<std::string, std::string> slurm_job; ///< its variables
    Noise noise;
};

/// Looks at the machine, and for so many seconds at its noise. Nothing of it is changed.
Findings examine_machine(double noise_seconds);

/// The findings as one object; null is what is not known.
nlohmann::ordered_json doctor_json(const Findings& findings);

/// How much neighbouring stretches of time differ, by their length, as lines with a bar each.
std::string noise_figure(const Noise& noise);

/// The findings for a reader: lines of at most 80 columns.
std::string doctor_text(const Findings& findings);

} // namespace carom
