#include "harness/commands/simulation_options.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "harness/command_line/values.hpp"
#include "harness/machine/other_build.hpp"
#include "harness/machine/threads.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/free_memory.hpp"
#include "harness/support/nearest.hpp"
#include "harness/support/note.hpp"
#include "harness/support/text.hpp"
#include "harness/verify/event_driven_violation.hpp"
#include "harness/verify/rounding.hpp"
#include "variants/event_driven_variant.hpp"
#include "variants/fastest.hpp"
#include "variants/least_memory.hpp"

namespace carom {
namespace {

constexpr int most = 1'000'000'000;

/// Below so many discs a step on one thread takes no longer than on two (docs/performance.md).
constexpr std::size_t fewest_discs_for_threads = 500;

/// From so many on, threads work so long between two waits that they gain even where they share processors.
constexpr std::size_t fewest_discs_to_share_processors = 50'000;

std::vector<std::string> variant_names() {
    std::vector<std::string> names{automatic, fastest_name};
    for (const Variant& variant : variants()) {
        names.emplace_back(variant.name);
    }
    names.emplace_back(event_driven().name);
    return names;
}

/// The variant that may have been meant.
std::string suggested_variant(const std::string& name) {
    constexpr std::array<std::string_view, 3> superlatives{"automatic", "best", "default"};
    return std::ranges::find(superlatives, name) != superlatives.end() ? automatic
                                                                       : nearest(name, variant_names());
}

void require_event_driven(const Scene& scene, const Tuning& tuning) {
    const std::string option = "--variant " + std::string(event_driven().name);
    if (tuning.substeps != 1) {
        throw InputError(option + ": found --substeps " + number_text(tuning.substeps) +
                         ", expected none: it takes no steps");
    }
    if (const auto overlap = overlap_at_start(scene)) {
        throw InputError(option + ": found that at the start " + *overlap +
                         ", expected discs apart from each other and from the walls, as `carom generate "
                         "--placement random` makes them");
    }
}

/// Requires room for the scene and its simulation. That of one with too few discs for `auto` to take the
/// fastest variant is not asked for; an unknown variant is told of later.
void require_room_to_simulate(const SimulationOptions& options, const Scene& box, std::size_t discs) {
    const bool fastest = options.variant == automatic || options.variant == fastest_name;
    const Variant* const variant = fastest ? &fastest_variant() : find_variant(options.variant);
    if (variant != nullptr) {
        const auto count = static_cast<std::int64_t>(discs);
        const int threads = options.tuning.threads;
        require_memory(count * static_cast<std::int64_t>(sizeof(Disc)) +
                           least_memory(*variant, box, count, threads),
                       counted(discs, "disc") + " on " + counted(threads, "thread"));
    }
}

} // namespace

void add_simulation_options(CLI::App& command, SimulationOptions& options) {
    options.tuning.threads = default_threads();
    command
        .add_option("SCENE", options.scene,
                    "Scene file: N, L, r, S, then N lines `i x y vx vy`; - is standard input")
        ->required();
    add_number(command, "THREADS,--threads", options.tuning.threads, 1, most_threads, "OpenMP threads")
        ->each([&options](const std::string& /*value*/) { options.threads_given = true; });
    command
        .add_option("--variant", options.variant,
                    "Name from `carom list`, or auto: the fastest for the scene")
        ->capture_default_str();
    add_library_option(command, options.library);
    add_tuning_options(command, options.tuning);
}

void add_library_option(CLI::App& command, std::string& library) {
    command.add_option(
        "--variants-of", library,
        "Shared library carom-variants.so of another build, whose code is run in place of this "
        "program's");
}

void add_tuning_options(CLI::App& command, Tuning& tuning) {
    add_number(command, "--find-chunk", tuning.find_chunk, 1, most,
               "Chunk of the find schedule: boxes that a thread takes at a time");
    add_number(command, "--resolve-chunk", tuning.resolve_chunk, 1, most,
               "Chunk of the resolve schedule: boxes or rows that a thread takes at a time");
    add_number(command, "--substeps", tuning.substeps, 1, most, "Steps per unit of time, dt = 1/K");
    add_number(command, "--sweep-limit", tuning.sweep_limit, 1, most,
               "Sweeps after which a resolve is given up");
    add_choice<Tolerance>(command, "--tolerance", tuning.tolerance,
                          {{"relative", Tolerance::relative}, {"published", Tolerance::published}},
                          "What counts as approaching: relative, or published (1e-7)");
}

Scene read_scene_and_settle_threads(SimulationOptions& options, AskedThreads meaning) {
    int& threads = options.tuning.threads;
    const bool asked = options.threads_given || std::getenv("OMP_NUM_THREADS") != nullptr;
    const bool fixed = threads > usable_processors() || std::getenv("OMP_DYNAMIC") != nullptr ||
                       (asked && meaning == AskedThreads::exactly);
    const int free = free_processors();
    if (free < threads) {
        wait_asleep();
    }
    if (asked) {
        require_threads(threads);
    }
    Scene scene = read_scene(options.scene, [&](const Scene& box, std::size_t discs) {
        require_room_to_simulate(options, box, discs);
    });
    const std::size_t discs = scene.discs.size();
    if (!fixed && discs < fewest_discs_for_threads) {
        threads = 1;
    } else if (!fixed && free < threads && discs < fewest_discs_to_share_processors) {
        options.threads_withheld = threads - free;
        threads = free;
    }
    require_threads(threads);
    return scene;
}

void note_crowding(int threads) {
    if (threads > usable_processors()) {
        note(counted(threads, "thread") + " on " + counted(usable_processors(), "processor") +
             ": they take turns, and wait for each other the longer");
    }
}

void note_withheld_threads(const SimulationOptions& options) {
    if (options.threads_withheld > 0) {
        const std::string asked = number_text(options.tuning.threads + options.threads_withheld);
        note("other programs had the processors: " + counted(options.tuning.threads, "thread") +
             " in place of " + asked + " (OMP_DYNAMIC=false for exactly " + asked + ")");
    }
}

const Variant& require_variant(const std::string& name) {
    if (name == fastest_name) {
        return fastest_variant();
    }
    if (const Variant* variant = find_variant(name)) {
        return *variant;
    }
    throw InputError("--variant: found " + in_quotes(name, 100) +
                     ", expected a name from `carom list`, such as '" + suggested_variant(name) + "'");
}

const Variant& require_variant(const std::string& name, const Scene& scene, const Tuning& tuning,
                               const std::string& library) {
    const Variant& variant = name == automatic ? fastest_variant(scene) : require_variant(name);
    if (!holds(variant.policies, scene)) {
        throw InputError("--variant " + name +
                         ": computes in float, and the scene has numbers beyond 1e15, a radius below "
                         "1e-15, or a fastest speed whose product with the radius is not within 1e-15 "
                         "to 1e17; expected a variant in double");
    }
    if (variant.engine == Engine::event_driven) {
        require_event_driven(scene, tuning);
    }
    return library.empty() ? variant : variant_of_build(library, variant.name);
}

} // namespace carom
