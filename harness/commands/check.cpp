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
#include "harness/verify/trajectory.hpp"

namespace carom {
namespace {

struct CheckOptions {
    SimulationOptions simulation;
    std::string trajectory; ///< empty: of a run of the variant
};

/// Checks what somebody's program wrote, by the rules of the variant's precision and impact.
void check_file(const CheckOptions& options) {
    const SimulationOptions& simulation = options.simulation;
    if (simulation.tuning.substeps != 1) {
        throw InputError(
            "--substeps: found beside --trajectory, whose states are whole steps apart; expected either");
    }
    const Scene scene = read_scene(simulation.scene, simulation.tuning.threads);
    const Policies policies = require_variant(simulation.variant, scene).policies;
    const Rounding rounding = rounding_of(policies);
    const Checker checker(scene.side, scene.radius, 1, simulation.tuning.tolerance, rounding,
                          policies.impact);
    TrajectoryFile file(options.trajectory, scene.discs.size());
    const CheckedTrajectory checked = check_trajectory(scene, file, checker, rounding);
    if (checked.violation) {
        throw CheckError(options.trajectory + ", " + *checked.violation);
    }
    std::printf("passed: %s, %d steps of %zu discs, energy drift %.2e, final state %s\n",
                options.trajectory.c_str(), scene.steps, scene.discs.size(),
                energy_drift(scene, checked.discs).value_or(0), state_hash(checked.discs).c_str());
}

void check_variant(const SimulationOptions& options) {
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
    auto options = std::make_shared<CheckOptions>();
    CLI::App* command = program.add_subcommand(
        "check", "Run and verify every step with an independent checker; exit 2 at the first violation");
    add_simulation_options(*command, options->simulation);
    command->add_option(
        "--trajectory", options->trajectory,
        "Check the steps in this file instead, lines `step i x y vx vy` that any program may have "
        "written (gzip too); --variant says in which precision and with which impact");
    command->callback([options] {
        if (options->trajectory.empty()) {
            check_variant(options->simulation);
        } else {
            check_file(*options);
        }
    });
}

} // namespace carom
