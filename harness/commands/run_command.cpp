#include <algorithm>
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
#include "harness/accuracy/errors_text.hpp"
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

/// Where the wall time of the process goes.
struct Seconds {
    double reading = 0;    ///< the scene's file
    double setting_up = 0; ///< the state of the simulation
    double steps = 0;
    double process = 0; ///< from before main until all that is to be printed of it is known

    double rest() const { return process - reading - setting_up - steps; }
};

/// A number that is told of a run.
struct Figure {
    const char* key;   ///< in JSON
    const char* label; ///< on a terminal; null: it does not stand there
    double value;
    const char* unit;
};

/// What a run did.
struct Summary {
    const SimulationOptions& options;
    const Scene& scene;
    const Variant& variant;
    int threads_asked;  ///< or taken for granted; there may be fewer
    std::int64_t steps; ///< of dt = 1/substeps; what is told by the step and by the second is of these
    std::vector<Figure> figures;        ///< of time, and by the second and by the step
    std::optional<double> energy_drift; ///< empty if nothing moves at the start
    int discs_outside;
    std::string state_hash; ///< empty if it is not to be printed: it takes its time
};

std::vector<Figure> figures_of(const Seconds& seconds, const Tally& work, double steps, double discs) {
    const auto per_step = [steps](std::int64_t total) {
        return steps > 0 ? static_cast<double>(total) / steps : 0;
    };
    const auto per_second = [&](double total) { return seconds.steps > 0 ? total / seconds.steps : 0; };
    return {{"reading_seconds", "reading", seconds.reading, " s"},
            {"setting_up_seconds", "setting up", seconds.setting_up, " s"},
            {"steps_seconds", "steps", seconds.steps, " s"},
            {"rest_seconds", nullptr, seconds.rest(), ""},
            {"process_seconds", "whole process", seconds.process, " s"},
            {"steps_per_second", "steps/s", per_second(steps), ""},
            {"disc_steps_per_second", "disc-steps/s", per_second(steps * discs), ""},
            {"overlaps_per_step", "overlaps", per_step(work.overlaps), " a step"},
            {"pair_resolves_per_step", "pair resolves", per_step(work.pair_resolves), " a step"},
            {"wall_resolves_per_step", "wall resolves", per_step(work.wall_resolves), " a step"},
            {"pair_attempts_per_step", nullptr, per_step(work.pair_attempts), ""},
            {"sweeps_per_step", "sweeps", per_step(work.sweeps), " a step"}};
}

Summary summarise(const RunOptions& options, int threads_asked, const Scene& scene, const Variant& variant,
                  const Run& run, Seconds seconds) {
    Summary summary{.options = options.simulation,
                    .scene = scene,
                    .variant = variant,
                    .threads_asked = threads_asked,
                    .steps = std::int64_t{scene.steps} * options.simulation.tuning.substeps,
                    .figures = {},
                    .energy_drift = energy_drift(scene, run.discs),
                    .discs_outside = discs_outside(scene, run.discs),
                    .state_hash = options.json ? state_hash(run.discs) : ""};
    seconds.steps = run.steps_seconds;
    seconds.process = process_seconds();
    summary.figures = figures_of(seconds, run.work, static_cast<double>(summary.steps),
                                 static_cast<double>(scene.discs.size()));
    return summary;
}

nlohmann::ordered_json summary_json(const Summary& summary) {
    const Tuning& tuning = summary.options.tuning;
    nlohmann::ordered_json json{{"scene", shown_name(summary.options.scene)},
                                {"variant", summary.variant.name},
                                {"policies", policies_json(summary.variant.policies, summary.variant.engine)},
                                {"threads", tuning.threads},
                                {"threads_asked", summary.threads_asked},
                                {"substeps", tuning.substeps},
                                {"particles", summary.scene.discs.size()},
                                {"steps", summary.scene.steps},
                                {"steps_simulated", summary.steps}};
    for (const Figure& figure : summary.figures) {
        json[figure.key] = figure.value;
    }
    json["energy_drift"] = or_null(summary.energy_drift);
    json["discs_outside"] = summary.discs_outside;
    json["state_hash"] = summary.state_hash;
    return json;
}

/// "60 steps", or "60 units of time in 480 steps"; without steps "60 units of time".
std::string steps_text(const Summary& summary) {
    const std::string units = counted(summary.scene.steps, "unit") + " of time";
    if (summary.variant.engine == Engine::event_driven) {
        return units;
    }
    const std::string steps = counted(summary.steps, "step");
    return summary.options.tuning.substeps == 1 ? steps : units + " in " + steps;
}

/// "2 threads", or "1 thread (of 2)".
std::string threads_text(const Summary& summary) {
    const bool fewer = summary.options.tuning.threads < summary.threads_asked;
    return counted(summary.options.tuning.threads, "thread") +
           (fewer ? " (of " + number_text(summary.threads_asked) + ")" : "");
}

void print_summary(const Summary& summary) {
    std::printf("%s: %s, %s, variant %s, %s\n", shown_name(summary.options.scene).c_str(),
                counted(summary.scene.discs.size(), "disc").c_str(), steps_text(summary).c_str(),
                std::string(summary.variant.name).c_str(), threads_text(summary).c_str());
    for (const Figure& figure : summary.figures) {
        if (figure.label != nullptr) {
            std::printf("  %-15s %12.6g%s\n", figure.label, figure.value, figure.unit);
        }
    }
    if (summary.energy_drift) {
        std::printf("  energy drift    %12.3g relative\n", *summary.energy_drift);
    } else {
        std::printf("  energy drift     not defined: nothing moves at the start\n");
    }
    std::printf("  discs outside   %12d\n", summary.discs_outside);
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
        options.simulation.variant = chosen->tried.method.variant->name;
        options.simulation.tuning.substeps = chosen->tried.method.substeps;
    }
    const Variant& variant = require_variant(options.simulation.variant, scene, options.simulation.tuning);
    if (variant.engine == Engine::event_driven) {
        int& threads = options.simulation.tuning.threads;
        threads = event_driven_threads(scene.discs.size(), threads);
        options.simulation.threads_withheld = 0;
    }
    const Run result = simulate(options, scene, variant, seconds);
    const Summary summary = summarise(options, asked, scene, variant, result, seconds);
    std::optional<ErrorMeasures> errors;
    if (options.errors) {
        errors = measure_errors(scene, variant, options.simulation.tuning);
    }
    if (options.json) {
        auto json = summary_json(summary);
        if (chosen) {
            json["choice"] = choice_json(*chosen);
        }
        if (errors) {
            json["errors"] = error_measures_json(*errors);
        }
        std::cout << json_text(json, 2) << '\n';
    } else {
        if (chosen) {
            print_choice(*chosen);
        }
        print_summary(summary);
        if (errors) {
            print_errors(*errors);
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
