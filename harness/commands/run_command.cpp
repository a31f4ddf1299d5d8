#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "harness/accuracy/error_measures.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/error_bound.hpp"
#include "harness/commands/simulation_options.hpp"
#include "harness/machine/disturbance.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/measure/measure.hpp"
#include "harness/records/policies_json.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/json.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/support/progress_bar.hpp"
#include "harness/support/text.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

struct RunOptions {
    SimulationOptions simulation;
    ErrorBound bound;
    std::string trajectory;
    bool errors = false;
    bool json = false;
};

using Json = nlohmann::ordered_json;

/// A number that a terminal shows, by its key in JSON.
struct Figure {
    const char* key;
    const char* label;
    const char* unit;
};

constexpr std::array shown_errors{
    Figure{"momentum_drift", "momentum that no wall explains", " of the sum of |v|"},
    Figure{"penetration_worst", "worst penetration", " r"},
    Figure{"penetration_mean", "mean penetration", " r"},
    Figure{"unresolved_pairs", "left colliding", ""},
    Figure{"collision_rate", "collisions", " a disc and unit of time"},
    Figure{"collision_rate_reference", "  of the reference", ""},
    Figure{"pressure", "pressure", ""},
    Figure{"pressure_reference", "  of the reference", ""},
    Figure{"speed_distance", "distance of the speeds", " (Kolmogorov-Smirnov)"},
    Figure{"time_to_tenth_radius", "0.1 r from the reference after", " units of time"}};

/// Prints every error measure (`error_measures_json`), a line each; what is not known says so.
void print_errors(const nlohmann::ordered_json& errors) {
    for (const auto& [key, label, unit] : shown_errors) {
        const auto& value = errors[key];
        if (value.is_number() && std::isfinite(value.get<double>())) {
            std::printf("  %-33s %12.6g%s\n", label, value.get<double>(), unit);
        } else {
            std::printf("  %-33s    not known\n", label);
        }
    }
    for (const auto& at : errors["trajectory"]) {
        std::printf("  distance after %6d units of time %13.6g r (root mean square)\n", at["time"].get<int>(),
                    at["rms_distance"].is_null() ? std::nan("") : at["rms_distance"].get<double>());
    }
    for (const char* reason : {"pressure_reason", "reference_reason"}) {
        if (!errors[reason].is_null()) {
            std::printf("  %s\n", errors[reason].get<std::string>().c_str());
        }
    }
}

/// Wall time of the process before its first step.
struct Seconds {
    double reading = 0;    ///< the scene's file
    double setting_up = 0; ///< the state of the simulation
};

constexpr std::array shown_figures{Figure{"reading_seconds", "reading", " s"},
                                   Figure{"setting_up_seconds", "setting up", " s"},
                                   Figure{"steps_seconds", "steps", " s"},
                                   Figure{"process_seconds", "whole process", " s"},
                                   Figure{"steps_per_second", "steps/s", ""},
                                   Figure{"disc_steps_per_second", "disc-steps/s", ""},
                                   Figure{"overlaps_per_step", "overlaps", " a step"},
                                   Figure{"pair_resolves_per_step", "pair resolves", " a step"},
                                   Figure{"wall_resolves_per_step", "wall resolves", " a step"},
                                   Figure{"sweeps_per_step", "sweeps", " a step"}};

/// What a run did. `threads_asked` are those asked for, or taken for granted; there may be fewer. Steps are
/// of dt = 1/substeps where they are told by the step or by the second. Of the process is told what it took
/// until all that is to be printed of it is known.
Json summary_json(const RunOptions& options, int threads_asked, const Scene& scene, const Variant& variant,
                  const Run& run, const Seconds& seconds) {
    const Tuning& tuning = options.simulation.tuning;
    const std::int64_t simulated = std::int64_t{scene.steps} * tuning.substeps;
    const auto steps = static_cast<double>(simulated);
    const auto per_step = [steps](std::int64_t total) {
        return steps > 0 ? static_cast<double>(total) / steps : 0;
    };
    const auto per_second = [&run](double total) {
        return run.steps_seconds > 0 ? total / run.steps_seconds : 0;
    };
    const auto drift = energy_drift(scene, run.discs);
    const int outside = discs_outside(scene, run.discs);
    const std::string hash = options.json ? state_hash(run.discs) : ""; // it takes its time
    const double process = process_seconds();
    return {{"scene", shown_name(options.simulation.scene)},
            {"variant", variant.name},
            {"policies", policies_json(variant.policies, variant.engine)},
            {"threads", tuning.threads},
            {"threads_asked", threads_asked},
            {"substeps", tuning.substeps},
            {"particles", scene.discs.size()},
            {"steps", scene.steps},
            {"steps_simulated", simulated},
            {"reading_seconds", seconds.reading},
            {"setting_up_seconds", seconds.setting_up},
            {"steps_seconds", run.steps_seconds},
            {"rest_seconds", process - seconds.reading - seconds.setting_up - run.steps_seconds},
            {"process_seconds", process},
            {"steps_per_second", per_second(steps)},
            {"disc_steps_per_second", per_second(steps * static_cast<double>(scene.discs.size()))},
            {"overlaps_per_step", per_step(run.work.overlaps)},
            {"pair_resolves_per_step", per_step(run.work.pair_resolves)},
            {"wall_resolves_per_step", per_step(run.work.wall_resolves)},
            {"pair_attempts_per_step", per_step(run.work.pair_attempts)},
            {"sweeps_per_step", per_step(run.work.sweeps)},
            {"energy_drift", or_null(drift)},
            {"discs_outside", outside},
            {"state_hash", hash}};
}

/// "60 steps", or "60 units of time in 480 steps"; without steps "60 units of time".
std::string steps_text(const Json& summary, Engine engine) {
    const std::string units = counted(summary["steps"].get<int>(), "unit") + " of time";
    if (engine == Engine::event_driven) {
        return units;
    }
    const std::string steps = counted(summary["steps_simulated"].get<std::int64_t>(), "step");
    return summary["substeps"] == 1 ? steps : units + " in " + steps;
}

/// "2 threads", or "1 thread (of 2)".
std::string threads_text(int threads, int asked) {
    return counted(threads, "thread") + (threads < asked ? " (of " + number_text(asked) + ")" : "");
}

void print_summary(const Json& summary, Engine engine) {
    std::printf("%s: %s, %s, variant %s, %s\n", summary["scene"].get<std::string>().c_str(),
                counted(summary["particles"].get<std::size_t>(), "disc").c_str(),
                steps_text(summary, engine).c_str(), summary["variant"].get<std::string>().c_str(),
                threads_text(summary["threads"], summary["threads_asked"]).c_str());
    for (const auto& [key, label, unit] : shown_figures) {
        std::printf("  %-15s %12.6g%s\n", label, summary[key].get<double>(), unit);
    }
    if (summary["energy_drift"].is_null()) {
        std::printf("  energy drift     not defined: nothing moves at the start\n");
    } else {
        std::printf("  energy drift    %12.3g relative\n", summary["energy_drift"].get<double>());
    }
    std::printf("  discs outside   %12d\n", summary["discs_outside"].get<int>());
}

std::string trajectory_lines(int step, const std::vector<Disc>& discs) {
    std::string text;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        append_number(text, step);
        text += ' ';
        append_disc(text, i, discs[i]);
    }
    return text;
}

Run simulate(const RunOptions& options, const Scene& scene, const Variant& variant, Seconds& seconds) {
    const Tuning& tuning = options.simulation.tuning;
    const double before = process_seconds();
    const auto simulation = variant.simulate(scene, tuning);
    seconds.setting_up = process_seconds() - before;
    std::optional<OutputFile> trajectory;
    if (!options.trajectory.empty()) {
        trajectory.emplace(options.trajectory);
        trajectory->write(trajectory_lines(0, scene.discs));
    }
    ProgressBar progress("simulating", scene.steps);
    const int at_once = trajectory               ? 1
                        : progress.on_terminal() ? std::max(scene.steps / 100, 1)
                                                 : scene.steps;
    RunInParts parts(scene, *simulation, tuning, CheckScope::nothing);
    while (!parts.ended()) {
        parts.advance(at_once);
        progress.show(parts.done());
        if (trajectory) {
            trajectory->write(trajectory_lines(parts.done(), simulation->discs()));
        }
    }
    const Run run = parts.finish();
    progress.clear();
    if (run.violation) {
        throw CheckError(shown_name(options.simulation.scene) + ", variant " + std::string(variant.name) +
                         ", " + *run.violation);
    }
    if (trajectory) {
        trajectory->finish();
    }
    return run;
}

void run(RunOptions options) {
    const DisturbanceWatch watch;
    Seconds seconds;
    const double before = process_seconds();
    const int asked = options.simulation.tuning.threads;
    const Scene scene = read_scene_and_settle_threads(options.simulation, AskedThreads::at_most);
    seconds.reading = process_seconds() - before;
    const auto chosen = choose_method(scene, options.bound, options.simulation);
    if (chosen) {
        options.simulation.variant = chosen->result.method.variant->name;
        options.simulation.tuning.substeps = chosen->result.method.substeps;
    }
    const Variant& variant = require_variant(options.simulation.variant, scene, options.simulation.tuning,
                                             options.simulation.library);
    if (variant.engine == Engine::event_driven) {
        int& threads = options.simulation.tuning.threads;
        threads = event_driven_threads(scene.discs.size(), threads);
        options.simulation.threads_withheld = 0;
    }
    const Run result = simulate(options, scene, variant, seconds);
    auto summary = summary_json(options, asked, scene, variant, result, seconds);
    Json errors;
    if (options.errors) {
        errors = error_measures_json(measure_errors(scene, variant, options.simulation.tuning));
    }
    if (options.json) {
        if (chosen) {
            summary["choice"] = choice_json(*chosen);
        }
        if (options.errors) {
            summary["errors"] = errors;
        }
        std::cout << json_text(summary, 2) << '\n';
    } else {
        if (chosen) {
            print_choice(*chosen);
        }
        print_summary(summary, variant.engine);
        if (options.errors) {
            print_errors(errors);
        }
    }
    note_crowding(options.simulation.tuning.threads);
    note_withheld_threads(options.simulation);
    if (options.simulation.tuning.threads == asked) {
        note_if_busy(watch, asked);
    }
}

} // namespace

void add_run_command(CLI::App& program) {
    auto options = std::make_shared<RunOptions>();
    CLI::App* command = program.add_subcommand("run", "Simulate a scene and print a short summary");
    options->simulation.variant = automatic;
    add_simulation_options(*command, options->simulation);
    add_error_bound_options(*command, options->bound);
    command->get_option("--threads")
        ->description("OpenMP threads at most; fewer for few discs or beside other programs");
    command->add_option("--trajectory", options->trajectory,
                        "File for the state at each unit of time: lines `step i x y vx vy`");
    command->add_flag("--errors", options->errors,
                      "Measure every error in one more run, beside the event-driven reference");
    command->add_flag("--json", options->json, "Print the summary as one JSON object");
    command->callback([options] { run(*options); });
}

} // namespace carom
