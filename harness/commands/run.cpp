#include <cstddef>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "harness/accuracy/error_measures.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/simulation_options.hpp"
#include "harness/machine/threads.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/measure/measure.hpp"
#include "harness/records/policies_json.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/json.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/support/progress_bar.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

struct RunOptions {
    SimulationOptions simulation;
    std::string trajectory;
    bool errors = false;
    bool json = false;
};

std::string trajectory_lines(int step, const std::vector<Disc>& discs) {
    std::string text;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        append_number(text, step);
        text += ' ';
        append_number(text, i);
        for (const double value : {discs[i].x, discs[i].y, discs[i].vx, discs[i].vy}) {
            text += ' ';
            append_number(text, value);
        }
        text += '\n';
    }
    return text;
}

nlohmann::ordered_json summary_json(const RunOptions& options, const Scene& scene, const Variant& variant,
                                    const Run& run) {
    const Tuning& tuning = options.simulation.tuning;
    const double steps = static_cast<double>(scene.steps) * tuning.substeps;
    const auto per_step = [steps](std::int64_t total) {
        return steps > 0 ? static_cast<double>(total) / steps : 0;
    };
    const auto per_second = [&run](double total) {
        return run.steps_seconds > 0 ? total / run.steps_seconds : 0;
    };
    const auto drift = energy_drift(scene, run.discs);
    nlohmann::ordered_json json{
        {"scene", options.simulation.scene},
        {"variant", variant.name},
        {"policies", policies_json(variant.policies)},
        {"threads", tuning.threads},
        {"substeps", tuning.substeps},
        {"particles", scene.discs.size()},
        {"steps", scene.steps},
        {"steps_seconds", run.steps_seconds},
        {"process_seconds", process_seconds()},
        {"steps_per_second", per_second(steps)},
        {"disc_steps_per_second", per_second(steps * static_cast<double>(scene.discs.size()))},
        {"overlaps_per_step", per_step(run.work.overlaps)},
        {"pair_resolves_per_step", per_step(run.work.pair_resolves)},
        {"wall_resolves_per_step", per_step(run.work.wall_resolves)},
        {"pair_attempts_per_step", per_step(run.work.pair_attempts)},
        {"sweeps_per_step", per_step(run.work.sweeps)},
        {"energy_drift", nullptr},
        {"discs_outside", discs_outside(scene, run.discs)},
        {"state_hash", state_hash(run.discs)}};
    if (drift) {
        json["energy_drift"] = *drift;
    }
    return json;
}

void print_errors(const nlohmann::ordered_json& errors) {
    const auto line = [&errors](const char* field, const char* what, const char* unit) {
        const auto& value = errors[field];
        if (value.is_null()) {
            std::printf("  %-33s    not known\n", what);
        } else {
            std::printf("  %-33s %12.6g %s\n", what, value.get<double>(), unit);
        }
    };
    line("momentum_drift", "momentum that no wall explains", "of the sum of |v|");
    line("penetration_worst", "worst penetration", "r");
    line("penetration_mean", "mean penetration", "r");
    line("unresolved_pairs", "left colliding", "");
    line("collision_rate", "collisions", "a disc and unit of time");
    line("collision_rate_reference", "  of the reference", "");
    line("pressure", "pressure", "");
    line("pressure_reference", "  of the reference", "");
    line("speed_distance", "distance of the speeds", "(Kolmogorov-Smirnov)");
    line("time_to_tenth_radius", "0.1 r from the reference after", "units of time");
    if (errors["trajectory"].is_array()) {
        for (const auto& at : errors["trajectory"]) {
            std::printf("  distance after %6d steps %21.6g r (root mean square)\n", at["time"].get<int>(),
                        at["rms_distance"].get<double>());
        }
    }
    for (const char* reason : {"pressure_reason", "reference_reason"}) {
        if (errors[reason].is_string()) {
            std::printf("  %s\n", errors[reason].get<std::string>().c_str());
        }
    }
}

void print_summary(const nlohmann::ordered_json& json) {
    const auto number = [&json](const char* field) { return json[field].get<double>(); };
    std::printf("%s: %zu discs, %d steps, variant %s, %d threads\n", json["scene"].get<std::string>().c_str(),
                json["particles"].get<std::size_t>(), json["steps"].get<int>(),
                json["variant"].get<std::string>().c_str(), json["threads"].get<int>());
    std::printf("  steps           %12.6g s\n", number("steps_seconds"));
    std::printf("  whole process   %12.6g s\n", number("process_seconds"));
    std::printf("  steps/s         %12.6g\n", number("steps_per_second"));
    std::printf("  disc-steps/s    %12.6g\n", number("disc_steps_per_second"));
    std::printf("  overlaps        %12.6g a step\n", number("overlaps_per_step"));
    std::printf("  pair resolves   %12.6g a step\n", number("pair_resolves_per_step"));
    std::printf("  wall resolves   %12.6g a step\n", number("wall_resolves_per_step"));
    std::printf("  sweeps          %12.6g a step\n", number("sweeps_per_step"));
    if (json["energy_drift"].is_null()) {
        std::printf("  energy drift     not defined: nothing moves at the start\n");
    } else {
        std::printf("  energy drift    %12.3g relative\n", number("energy_drift"));
    }
    std::printf("  discs outside   %12d\n", json["discs_outside"].get<int>());
}

Run simulate(const RunOptions& options, const Scene& scene, const Variant& variant) {
    const Tuning& tuning = options.simulation.tuning;
    const auto simulation = variant.simulate(scene, tuning);
    std::optional<OutputFile> trajectory;
    if (!options.trajectory.empty()) {
        trajectory.emplace(options.trajectory);
        trajectory->write(trajectory_lines(0, scene.discs));
    }
    ProgressBar progress("simulating", scene.steps);
    Run run = run_scene(scene, *simulation, tuning, CheckScope::nothing,
                        [&](int step, const std::vector<Disc>& discs) {
                            progress.show(step);
                            if (trajectory) {
                                trajectory->write(trajectory_lines(step, discs));
                            }
                        });
    progress.clear();
    if (run.violation) {
        throw CheckError(options.simulation.scene + ", variant " + std::string(variant.name) + ", " +
                         *run.violation);
    }
    if (trajectory) {
        trajectory->finish();
    }
    return run;
}

void run(const RunOptions& options) {
    require_threads(options.simulation.tuning.threads);
    const Scene scene = read_scene(options.simulation.scene);
    const Variant& variant = require_variant(options.simulation.variant, scene);
    const Run result = simulate(options, scene, variant);
    auto json = summary_json(options, scene, variant, result);
    if (options.errors) {
        json["errors"] = error_measures_json(measure_errors(scene, variant, options.simulation.tuning));
    }
    if (options.json) {
        std::cout << json_text(json, 2) << '\n';
    } else {
        print_summary(json);
        if (options.errors) {
            print_errors(json["errors"]);
        }
    }
}

} // namespace

void add_run_command(CLI::App& program) {
    auto options = std::make_shared<RunOptions>();
    CLI::App* command = program.add_subcommand("run", "Simulate a scene and print a short summary");
    options->simulation.variant = automatic;
    add_simulation_options(*command, options->simulation);
    command->add_option("--trajectory", options->trajectory,
                        "File for the state at each unit of time: lines `step i x y vx vy`");
    command->add_flag("--errors", options->errors,
                      "Measure every error in one more run, beside the event-driven reference");
    command->add_flag("--json", options->json, "Print the summary as one JSON object");
    command->callback([options] { run(*options); });
}

} // namespace carom
