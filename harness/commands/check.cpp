#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "harness/commands/commands.hpp"
#include "harness/commands/simulation_options.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/measure/measure.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/json.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

struct CheckOptions {
    SimulationOptions simulation;
    bool json = false;
};

void print_json(const std::string& name, const Scene& scene, const Variant& variant, const Tuning& tuning,
                const Run& run) {
    const nlohmann::ordered_json json{
        {"verdict", run.violation ? "failed" : "passed"},
        {"reason", or_null(run.violation)},
        {"scene", name},
        {"variant", variant.name},
        {"threads", tuning.threads},
        {"substeps", tuning.substeps},
        {"particles", scene.discs.size()},
        {"steps", scene.steps},
        {"energy_drift", run.violation ? nullptr : number_or_null(energy_drift(scene, run.discs))},
        {"state_hash", text_or_null(run.violation ? "" : state_hash(run.discs))}};
    std::cout << json_text(json, 2) << '\n';
}

void print_line(const std::string& name, const Scene& scene, const Variant& variant, const Run& run) {
    std::printf("passed: %s, variant %s, %s of %s, energy drift %.2e, final state %s\n", name.c_str(),
                std::string(variant.name).c_str(), counted(scene.steps, "step").c_str(),
                counted(scene.discs.size(), "disc").c_str(), energy_drift(scene, run.discs).value_or(0),
                state_hash(run.discs).c_str());
}

void check(CheckOptions options) {
    const Tuning& tuning = options.simulation.tuning;
    const std::string name = shown_name(options.simulation.scene);
    const Scene scene = read_scene_and_settle_threads(options.simulation, AskedThreads::exactly);
    const Variant& variant = require_variant(options.simulation.variant, scene);
    note_crowding(tuning.threads);
    const auto simulation = variant.simulate(scene, tuning);
    const Run run = run_scene(scene, *simulation, tuning, {CheckScope::every_step, variant.policies});
    if (options.json) {
        print_json(name, scene, variant, tuning, run);
    }
    if (run.violation) {
        throw CheckError(name + ", variant " + std::string(variant.name) + ", " + *run.violation);
    }
    if (!options.json) {
        print_line(name, scene, variant, run);
    }
}

} // namespace

void add_check_command(CLI::App& program) {
    auto options = std::make_shared<CheckOptions>();
    CLI::App* command = program.add_subcommand(
        "check", "Run and verify every step with an independent checker; exit 2 at the first violation");
    add_simulation_options(*command, options->simulation);
    command->add_flag("--json", options->json, "Print the verdict as one JSON object, also of what fails");
    command->callback([options] { check(*options); });
}

} // namespace carom
