#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/measurement_options.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/machine/suspensions.hpp"
#include "harness/measure/chipmunk.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/measure/measure.hpp"
#include "harness/records/record.hpp"
#include "harness/support/format.hpp"
#include "harness/support/json.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

struct OutsideOptions {
    std::string scene;
    int substeps = 1;
    int iterations = 10;
    std::string record;
    std::vector<std::string> tags;
};

nlohmann::ordered_json outside_json(const OutsideOptions& options, const LoadedScene& loaded,
                                    const ChipmunkRun& run) {
    const auto drift = energy_drift(loaded.scene, run.discs);
    return record_of(
        "outside", options.tags,
        {{"engine", {{"name", "Chipmunk"}, {"version", run.version}, {"iterations", options.iterations}}},
         {"axes", {{"threads", 1}, {"substeps", options.substeps}}},
         {"scene", scene_json(loaded.scene, loaded.name, loaded.sha256)},
         {"repetitions", {{{"steps_seconds", run.steps_seconds}, {"cpu_seconds", run.cpu_seconds}}}},
         {"errors",
          {{"energy_drift", number_or_null(drift)},
           {"discs_outside", discs_outside(loaded.scene, run.discs)}}},
         {"provenance", provenance_json(1)}});
}

void outside(const OutsideOptions& options) {
    tags_json(options.tags);
    require_writable(options.record);
    const LoadedScene loaded = load_scene(options.scene);
    Suspensions suspensions;
    suspensions.start();
    const ChipmunkRun run = run_chipmunk(loaded.scene, options.substeps, options.iterations);
    suspensions.require_none(loaded.name);
    std::cout << format("%s: %s, %s, Chipmunk %s, 1 thread\n", loaded.name.c_str(),
                        counted(loaded.scene.discs.size(), "disc").c_str(),
                        counted(loaded.scene.steps, "step").c_str(), run.version.c_str());
    std::cout << format("  steps            %10.6g s\n", run.steps_seconds);
    if (const auto drift = energy_drift(loaded.scene, run.discs)) {
        std::cout << format("  energy drift     %10.3g relative\n", *drift);
    }
    std::cout << format("  discs outside    %10d\n", discs_outside(loaded.scene, run.discs));
    if (!options.record.empty()) {
        write_record(options.record, outside_json(options, loaded, run));
    }
}

} // namespace

void add_outside_command(CLI::App& program) {
    auto options = std::make_shared<OutsideOptions>();
    CLI::App* command = program.add_subcommand(
        "outside", "Simulate by Chipmunk, a general engine, to stand beside; only where built with it");
    add_scene_option(*command, options->scene);
    add_number(*command, "--substeps", options->substeps, 1, 1'000'000'000,
               "Steps per unit of time, dt = 1/K");
    add_number(*command, "--iterations", options->iterations, 1, 1'000'000,
               "Iterations of its solver in each step");
    add_record_options(*command, options->record, options->tags);
    command->callback([options] { outside(*options); });
}

} // namespace carom
