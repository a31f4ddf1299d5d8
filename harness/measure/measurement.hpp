#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/measure/measure.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// How a run was timed that took turns with others in its process.
struct Turns {
    int contenders = 0;          ///< that took turns, this one among them
    std::uint64_t seed = 0;      ///< of the order of the turns
    std::vector<double> seconds; ///< wall time of each turn
};

/// What of a measured process goes into its record (record.schema.json).
struct Measurement {
    const Scene& scene;
    std::string scene_name;   ///< file name, without folders
    std::string scene_sha256; ///< of the file's bytes
    const Variant& variant;
    Tuning tuning;
    CheckScope scope = CheckScope::last_step;
    int warm_ups = 0;
    double parse_seconds = 0;
    std::vector<std::string> tags;        ///< KEY=VALUE
    std::vector<Run> repetitions;         ///< all of them, in the order they ran
    std::optional<std::string> violation; ///< of the first run that failed its check
    std::optional<Turns> turns;           ///< empty if it had its process for itself
    std::optional<double> own_seconds;    ///< of a process of several: those spent on this one
};

} // namespace carom
