#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/measure/stated_time.hpp"
#include "harness/records/sources.hpp"
#include "harness/side_by_side/program_contender.hpp"

namespace carom {

/// How a process was timed that took turns with others.
struct ProcessTurns {
    int contenders = 0;          ///< that took turns, this one among them
    std::uint64_t seed = 0;      ///< of the order of the turns
    std::vector<double> seconds; ///< wall time of each turn
};

/// What of a whole process that was measured goes into its record (record.schema.json).
struct ProcessMeasurement {
    const ProcessCommand& command;
    const Measured& measured;          ///< with at least one run
    std::vector<StatedTime> stated;    ///< of each run; empty if the time from outside is the one that counts
    std::optional<ProcessTurns> turns; ///< empty if no other took turns with it
    nlohmann::ordered_json axes;       ///< what was chosen, by name
    nlohmann::ordered_json scene;      ///< as scene_json, or null
    const Sources& sources;            ///< the files that make up the program
    nlohmann::ordered_json build;      ///< what is known of how it was built, as in a record's provenance
    std::string checked;               ///< how its result was checked beforehand; empty if it was not
    std::vector<std::string> tags;     ///< KEY=VALUE
    int threads = 1;
    int warm_ups = 0; ///< untimed processes before it
};

/// The record of the process, of kind "process". Its provenance is that of this program, which measured it,
/// but for `build`, for the environment, and for the hash of the program.
nlohmann::ordered_json process_json(const ProcessMeasurement& measurement);

} // namespace carom
