#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
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

/// What a run did, by the step and by the second.
struct Summary {
    std::string scene;
    std::string_view variant;
    Engine engine;
    Policies policies;
    int threads;
    int threads_asked = 0; ///< or taken for granted; there may be fewer
    int substeps;
    std::size_t particles;
    int units_of_time;  ///< the scene's S
    std::int64_t steps; ///< of dt = 1/substeps; what is told by the step and by the second is told of these
    double steps_per_second;
    double disc_steps_per_second;
    double overlaps_per_step;
    double pair_resolves_per_step;
    double wall_resolves_per_step;
    double pair_attempts_per_step;
    double sweeps_per_step;
    std::optional<double> energy_drift; ///< empty if nothing moves at the start
    int discs_outside;
    std::string state_hash; ///< empty if it is not to be printed: it takes its time
    Seconds seconds;
};

Summary summarise(const RunOptions& options, const Scene& scene, const Variant& variant, const Run& run,
                  const Seconds& seconds) {
    const Tuning& tuning = options.simulation.tuning;
    const std::int64_t steps = std::int64_t{scene.steps} * tuning.substeps;
    const auto per_step = [steps](std::int64_t total) {
        return steps > 0 ? static_cast<double>(total) / static_cast<double>(steps) : 0;
    };
    const auto per_second = [&run](double total) {
        return run.steps_seconds > 0 ? total / run.steps_seconds : 0;
    };
    return {.scene = shown_name(options.simulation.scene),
            .variant = variant.name,
            .engine = variant.engine,
            .policies = variant.policies,
            .threads = tuning.threads,
            .substeps = tuning.substeps,
            .particles = scene.discs.size(),
            .units_of_time = scene.steps,
            .steps = steps,
            .steps_per_second = per_second(static_cast<double>(steps)),
            .disc_steps_per_second =
                per_second(static_cast<double>(steps) * static_cast<double>(scene.discs.size())),
            .overlaps_per_step = per_step(run.work.overlaps),
            .pair_resolves_per_step = per_step(run.work.pair_resolves),
            .wall_resolves_per_step = per_step(run.work.wall_resolves),
            .pair_attempts_per_step = per_step(run.work.pair_attempts),
            .sweeps_per_step = per_step(run.work.sweeps),
            .energy_drift = energy_drift(scene, run.discs),
            .discs_outside = discs_outside(scene, run.discs),
            .state_hash = options.json ? state_hash(run.discs) : "",
            .seconds = {.reading = seconds.reading,
                        .setting_up = seconds.setting_up,
                        .steps = run.steps_seconds,
                        .process = process_seconds()}};
}

nlohmann::ordered_json summary_json(const Summary& summary) {
    return {{"scene", summary.scene},
            {"variant", summary.variant},
            {"policies", policies_json(summary.policies, summary.engine)},
            {"threads", summary.threads},
            {"threads_asked", summary.threads_asked},
            {"substeps", summary.substeps},
            {"particles", summary.particles},
            {"steps", summary.units_of_time},
            {"steps_simulated", summary.steps},
            {"reading_seconds", summary.seconds.reading},
            {"setting_up_seconds", summary.seconds.setting_up},
            {"steps_seconds", summary.seconds.steps},
            {"rest_seconds", summary.seconds.rest()},
            {"process_seconds", summary.seconds.process},
            {"steps_per_second", summary.steps_per_second},
            {"disc_steps_per_second", summary.disc_steps_per_second},
            {"overlaps_per_step", summary.overlaps_per_step},
            {"pair_resolves_per_step", summary.pair_resolves_per_step},
            {"wall_resolves_per_step", summary.wall_resolves_per_step},
            {"pair_attempts_per_step", summary.pair_attempts_per_step},
            {"sweeps_per_step", summary.sweeps_per_step},
            {"energy_drift", or_null(summary.energy_drift)},
            {"discs_outside", summary.discs_outside},
            {"state_hash", summary.state_hash}};
}

/// "60 steps", or "60 units of time in 480 steps"; without steps "60 units of time".
std::string steps_text(const Summary& summary) {
    if (summary.engine == Engine::event_driven) {
        return counted(summary.units_of_time, "unit") + " of time";
    }
    const std::string steps = counted(summary.steps, "step");
    return summary.substeps == 1 ? steps : counted(summary.units_of_time, "unit") + " of time in " + steps;
}

/// "2 threads", or "1 thread (of 2)".
std::string threads_text(const Summary& summary) {
    const bool fewer = summary.threads < summary.threads_asked;
    return counted(summary.threads, "thread") +
           (fewer ? " (of " + number_text(summary.threads_asked) + ")" : "");
}

void print_summary(const Summary& summary) {
    std::printf("%s: %s, %s, variant %s, %s\n", summary.scene.c_str(),
                counted(summary.particles, "disc").c_str(), steps_text(summary).c_str(),
                std::string(summary.variant).c_str(), threads_text(summary).c_str());
    std::printf("  reading         %12.6g s\n", summary.seconds.reading);
    std::printf("  setting up      %12.6g s\n", summary.seconds.setting_up);
    std::printf("  steps           %12.6g s\n", summary.seconds.steps);
    std::printf("  whole process   %12.6g s\n", summary.seconds.process);
    std::printf("  steps/s         %12.6g\n", summary.steps_per_second);
    std::printf("  disc-steps/s    %12.6g\n", summary.disc_steps_per_second);
    std::printf("  overlaps        %12.6g a step\n", summary.overlaps_per_step);
    std::printf("  pair resolves   %12.6g a step\n", summary.pair_resolves_per_step);
    std::printf("  wall resolves   %12.6g a step\n", summary.wall_resolves_per_step);
    std::printf("  sweeps          %12.6g a step\n", summary.sweeps_per_step);
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
    Run run =
        run_scene(scene, *simulation, tuning, CheckScope::nothing, [&](int step, const Simulation& now) {
            progress.show(step);
            if (trajectory) {
                trajectory->write(trajectory_lines(step, now.discs()));
            }
        });
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
        options.simulation.tuning.threads = 1;
        options.simulation.threads_withheld = 0;
    }
    const Run result = simulate(options, scene, variant, seconds);
    Summary summary = summarise(options, scene, variant, result, seconds);
    summary.threads_asked = asked;
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
    note_crowding(summary.threads);
    note_withheld_threads(options.simulation);
    if (summary.threads == asked) {
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
