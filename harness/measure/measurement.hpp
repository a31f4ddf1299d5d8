#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/measure/measure.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// What of a measured process goes into its record (record.schema.json).
struct Measurement {
    const Scene& scene;
    std::string scene_name;   ///< file name, without folders
    std::string scene_sha256; ///< of the file's bytes
    const Variant& variant;
    std::string library = {}; ///< of another build, that the variant is of; empty: this program
    Tuning tuning;
    CheckScope scope = CheckScope::last_step;
    int warm_ups = 0;
    double parse_seconds = 0;
    std::vector<std::string> tags = {}; ///< KEY=VALUE
    std::vector<Run> repetitions = {};  ///< all of them, in the order they ran; only the last has its discs
    std::optional<std::string> violation = {}; ///< of the first run that failed its check
    std::optional<double> own_seconds = {};    ///< of a process of several: those spent on this one

    /// Adds a run from the scene's initial state, as all are: it must end in the same bits as the one before,
    /// after the same work.
    void add(Run run);

    /// A run from the scene's initial state, in a simulation of its own, of which these steps are checked.
    Run run_alone(CheckScope checked, Stopwatch stopwatch = {}) const;

    /// Scene and variant, for a message.
    std::string name() const { return scene_name + ", variant " + std::string(variant.name); }
};

} // namespace carom
