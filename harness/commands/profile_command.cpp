#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/measurement_options.hpp"
#include "harness/commands/profile_table.hpp"
#include "harness/commands/simulation_options.hpp"
#include "harness/counters/cachegrind.hpp"
#include "harness/counters/counters.hpp"
#include "harness/machine/disturbance.hpp"
#include "harness/machine/suspensions.hpp"
#include "harness/machine/threads.hpp"
#include "harness/measure/profiler.hpp"
#include "harness/measure/timeline.hpp"
#include "harness/records/profile_json.hpp"
#include "harness/records/record.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

struct ProfileOptions {
    SimulationOptions simulation;
    MeasurementOptions measurement;
    std::vector<std::string> counters;
    std::string timeline;
    bool timeline_chunks = false;
    bool simulated = false;
    int simulated_steps = 5;
};

/// A run without a probe. Throws CheckError if it fails its check.
Run bare_run(const Measurement& measurement, CheckScope scope, Stopwatch stopwatch = {}) {
    Run run = measurement.run_alone(scope, std::move(stopwatch));
    if (run.violation) {
        throw CheckError(measurement.name() + ", " + *run.violation);
    }
    return run;
}

/// The profiled run; the same to the last bit as the bare one, or CheckError.
Run profiled_run(const Measurement& measurement, Profiler& profiler, const Run& bare) {
    const auto simulation =
        measurement.variant.simulate_observed(measurement.scene, measurement.tuning, profiler);
    Run run = run_scene(measurement.scene, *simulation, measurement.tuning,
                        {CheckScope::last_step, measurement.variant});
    if (!run.violation && run.discs != bare.discs) {
        run.violation = "the profiled run ends in another state than the bare one";
    }
    if (run.violation) {
        throw CheckError(measurement.scene_name + ": " + *run.violation);
    }
    return run;
}

std::vector<CounterValue> all_counters(const ProfileOptions& options, const Measurement& measurement) {
    auto values = count(options.counters, measurement.tuning.threads, [&measurement](Stopwatch stopwatch) {
        bare_run(measurement, CheckScope::nothing, std::move(stopwatch));
    });
    if (options.simulated) {
        const auto simulated = simulate_counters(measurement.scene, measurement.variant.name,
                                                 measurement.tuning, options.simulated_steps);
        values.insert(values.end(), simulated.begin(), simulated.end());
    }
    return values;
}

void profile(const ProfileOptions& options) {
    const DisturbanceWatch watch;
    require_threads(options.simulation.tuning.threads);
    const int threads = options.simulation.tuning.threads;
    const LoadedScene loaded = load_scene(options.simulation.scene);
    const Variant& variant = require_variant(options.simulation.variant, loaded.scene,
                                             options.simulation.tuning, options.simulation.library);
    if (variant.simulate_observed == nullptr) {
        throw InputError("--variant " + options.simulation.variant +
                         ": found a variant without phases, expected one with steps");
    }
    Measurement measurement = measurement_of(loaded, variant, options.simulation.tuning, options.measurement,
                                             options.simulation.library);

    Suspensions suspensions;
    suspensions.start();
    for (int k = 0; k < options.measurement.warm_ups; ++k) {
        bare_run(measurement, CheckScope::nothing);
    }
    if (options.measurement.scope == CheckScope::every_step) {
        bare_run(measurement, CheckScope::every_step);
    }
    const Run bare = bare_run(measurement, CheckScope::last_step);
    Profiler profiler(variant.policies, measurement.tuning,
                      {.spans = !options.timeline.empty(), .chunks = options.timeline_chunks});
    Run run = profiled_run(measurement, profiler, bare);
    const Profile result{.profiler = profiler,
                         .wall_seconds = run.steps_seconds,
                         .cost = run.steps_seconds / bare.steps_seconds,
                         .sweeps = run.work.sweeps,
                         .counters = all_counters(options, measurement)};
    suspensions.require_none(measurement.name());
    print_profile(result, measurement);
    if (!options.timeline.empty()) {
        write_timeline(options.timeline, profiler,
                       std::string(variant.name) + ", " + measurement.scene_name + ", " +
                           counted(threads, "thread"));
    }
    if (!options.measurement.record.empty()) {
        measurement.repetitions.push_back(std::move(run));
        auto one = contender_json(measurement);
        one["repetitions"] = nlohmann::ordered_json::array();
        one["profile"] = profile_json(result);
        write_record(options.measurement.record, "profile", nlohmann::ordered_json::array({one}), threads);
    }
    note_crowding(threads);
    note_if_busy(watch, threads);
}

} // namespace

void add_profile_command(CLI::App& program) {
    auto options = std::make_shared<ProfileOptions>();
    CLI::App* command = program.add_subcommand(
        "profile", "Profile one run by phase and thread, and count events in runs of their own");
    add_simulation_options(*command, options->simulation);
    add_measurement_options(*command, options->measurement);
    command
        ->add_option("--counters", options->counters,
                     "PAPI presets or native events instead of the usual ones")
        ->delimiter(',')
        ->allow_extra_args(false);
    command->add_flag("--simulated", options->simulated,
                      "Also count under valgrind's cachegrind, on one thread");
    add_number(*command, "--simulated-steps", options->simulated_steps, 1, 1'000'000,
               "Steps to run under cachegrind");
    auto* timeline = command->add_option("--timeline", options->timeline,
                                         "File for the timeline in Trace Event format (open in Perfetto)");
    timeline->check(writable());
    command->add_flag("--timeline-chunks", options->timeline_chunks, "Show chunks in the timeline, too")
        ->needs(timeline);
    command->callback([options] { profile(*options); });
}

} // namespace carom
