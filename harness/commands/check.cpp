#include <cstdio>
#include <memory>
#include <string>

#include "harness/commands/commands.hpp"
#include "harness/commands/simulation_options.hpp"
#include "harness/machine/threads.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/measure/measure.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"

namespace carom {
namespace {

void check(const SimulationOptions& options) {
    require_threads(options.tuning.threads);
    const Scene scene = read_scene(options.scene, options.tuning.threads);
    const Variant& variant = require_variant(options.variant, scene);
    const auto simulation = variant.simulate(scene, options.tuning);
    const Run run = run_scene(scene, *simulation, options.tuning, {CheckScope::every_step, variant.policies});
    if (run.violation) {
        throw CheckError(options.scene + ", variant " + std::string(variant.name) + ", " + *run.violation);
    }
    std::printf("passed: %s, variant %s, %d steps of %zu discs, energy drift %.2e, final state %s\n",
                options.scene.c_str(), std::string(variant.name).c_str(), scene.steps, scene.discs.size(),
                energy_drift(scene, run.discs).value_or(0), state_hash(run.discs).c_str());
}

} // namespace

void add_check_command(CLI::App& program) {
    auto options = std::make_shared<SimulationOptions>();
    CLI::App* command = program.add_subcommand(
        "check", "Run and verify every step with an independent checker; exit 2 at the first violation");
    add_simulation_options(*command, *options);
    command->callback([options] { check(*options); });
}

} // namespace carom
