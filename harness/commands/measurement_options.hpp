#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/measure/measure.hpp"
#include "harness/measure/measurement.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// What the verbs that write records have in common.
struct MeasurementOptions {
    std::string record;
    std::vector<std::string> tags;
    int warm_ups = 1;
    CheckScope scope = CheckScope::last_step;
};

/// Adds SCENE.
void add_scene_option(CLI::App& command, std::string& scene);

/// Adds --record and --tag.
void add_record_options(CLI::App& command, std::string& record, std::vector<std::string>& tags);

/// Adds --record, --tag, --warm-up and --check.
void add_measurement_options(CLI::App& command, MeasurementOptions& options);

/// A scene with what a record says of its file.
struct LoadedScene {
    Scene scene;
    std::string name;   ///< of the file, without folders
    std::string sha256; ///< of its bytes
    double parse_seconds = 0;
};

/// Reads and parses a scene file. Throws InputError, also if the scene has no steps to time.
LoadedScene load_scene(const std::string& path);

/// A measurement of that scene that has yet to run; `library` is the one that the variant is of, or empty.
/// `loaded` must outlive it.
Measurement measurement_of(const LoadedScene& loaded, const Variant& variant, const Tuning& tuning,
                           const MeasurementOptions& options, const std::string& library);

} // namespace carom
