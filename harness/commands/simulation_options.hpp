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
    std::string library; ///< that the variant is taken from, of another build; empty: this program
    Tuning tuning;
    bool threads_given = false; ///< on the command line
    int threads_withheld = 0;   ///< of those, since other programs had the processors
};

/// The name that stands for the fastest variant for the scene.
inline constexpr auto automatic = "auto";

/// The short name of the variant that is the fastest for all but the smallest scenes.
inline constexpr auto fastest_name = "fastest";

/// Adds SCENE, THREADS, --variant, --threads and the tunings. `options` holds the defaults.
void add_simulation_options(CLI::App& command, SimulationOptions& options);

/// Adds --variants-of.
void add_library_option(CLI::App& command, std::string& library);

/// Adds the tunings alone: chunks, substeps, tolerance and sweep limit.
void add_tuning_options(CLI::App& command, Tuning& tuning);

/// What a number of threads means that was asked for, on the command line or by OMP_NUM_THREADS.
enum class AskedThreads { exactly, at_most };

/// Reads the scene of a verb that does not measure, and settles on its threads: those asked for, or fewer,
/// which it may take if nobody asked or so many are the most: one for a scene too small to gain by a second,
/// and no more than there are processors that other programs leave, unless the scene is large. More than the
/// machine has, and any number if OMP_DYNAMIC is set, is taken as it is. The result is the same on any.
/// Throws InputError.
Scene read_scene_and_settle_threads(SimulationOptions& options, AskedThreads meaning);

/// Says so if these are more threads than the processors that this process may use.
void note_crowding(int threads);

/// Says so if fewer threads ran than were asked for, since other programs had the processors.
void note_withheld_threads(const SimulationOptions& options);

/// The variant of that name; throws InputError with the nearest name if there is none.
const Variant& require_variant(const std::string& name);

/// The same, or, for `automatic`, the fastest for the scene; as `library` has it, if one is named. Throws
/// InputError also for a variant that can do nothing with this scene or this tuning.
const Variant& require_variant(const std::string& name, const Scene& scene, const Tuning& tuning,
                               const std::string& library = "");

} // namespace carom
