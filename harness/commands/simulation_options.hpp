#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "kernels/policies.hpp"
#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// What the verbs that simulate have in common.
struct SimulationOptions {
    std::string scene;
    std::string variant = "published";
    Tuning tuning;
};

/// The name that stands for the fastest variant for the scene.
inline constexpr auto automatic = "auto";

/// Adds SCENE, THREADS, --variant, --threads and the tunings. `options` holds the defaults.
void add_simulation_options(CLI::App& command, SimulationOptions& options);

/// Adds the tunings alone: chunks, substeps, tolerance and sweep limit.
void add_tuning_options(CLI::App& command, Tuning& tuning);

/// The variant of that name; throws InputError with the nearest names if there is none.
const Variant& require_variant(const std::string& name);

/// The same, or, for `automatic`, the fastest for the scene.
const Variant& require_variant(const std::string& name, const Scene& scene);

} // namespace carom
