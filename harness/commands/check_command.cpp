#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/commands/commands.hpp"
#include "harness/commands/simulation_options.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/measure/measure.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/json.hpp"
#include "harness/support/text.hpp"
#include "harness/verify/trajectory.hpp"

namespace carom {
namespace {

struct CheckOptions {
    SimulationOptions simulation;
    std::string trajectory; ///< empty: the steps are those of a run of the variant
    bool json = false;
};

/// What came of a check.
struct Verdict {
    std::string what; ///< the scene and the variant, or the file that was checked
    std::vector<Disc> discs;
    std::optional<std::string> violation;
    const char* scope; ///< what was looked at, as --json has it
};

/// Checks what somebody's program wrote, by the rules of the variant's precision and impact.
Verdict check_file(const CheckOptions& options, const Scene& scene, const Variant& variant) {
    const Tuning& tuning = options.simulation.tuning;
    if (tuning.substeps != 1) {
        throw InputError("--substeps: found beside --trajectory, whose states are whole steps apart; "
                         "expected only one of the two");
    }
    const Rounding rounding = rounding_of(variant.policies);
    const Checker checker(scene.side, scene.radius, 1, tuning.tolerance, rounding, variant.policies.impact,
                          variant.engine);
    CheckedTrajectory checked = check_trajectory(scene, options.trajectory, checker, rounding);
    return {options.trajectory, std::move(checked.discs), std::move(checked.violation), "states"};
}

Verdict check_variant(const std::string& name, const Tuning& tuning, const Scene& scene,
                      const Variant& variant) {
    Run run = checked_run(scene, variant, tuning);
    return {name + ", variant " + std::string(variant.name), std::move(run.discs), std::move(run.violation),
            variant.simulate_logged != nullptr ? "every-collision" : "every-step"};
}

void print_json(const CheckOptions& options, const Scene& scene, const Variant& variant,
                const Verdict& verdict) {
    const Tuning& tuning = options.simulation.tuning;
    const bool passed = !verdict.violation;
    const nlohmann::ordered_json json{
        {"verdict", passed ? "passed" : "failed"},
        {"reason", or_null(verdict.violation)},
        {"scope", verdict.scope},
        {"scene", shown_name(options.simulation.scene)},
        {"trajectory", text_or_null(options.trajectory)},
        {"variant", variant.name},
        {"threads", tuning.threads},
        {"substeps", tuning.substeps},
        {"particles", scene.discs.size()},
        {"steps", scene.steps},
        {"energy_drift", passed ? number_or_null(energy_drift(scene, verdict.discs)) : nullptr},
        {"state_hash", text_or_null(passed ? state_hash(verdict.discs) : "")}};
    std::cout << json_text(json, 2) << '\n';
}

void print_line(const Scene& scene, const Verdict& verdict) {
    std::printf("passed: %s, %s of %s, energy drift %.2e, final state %s\n", verdict.what.c_str(),
                counted(scene.steps, "step").c_str(), counted(scene.discs.size(), "disc").c_str(),
                energy_drift(scene, verdict.discs).value_or(0), state_hash(verdict.discs).c_str());
}

void check(CheckOptions options) {
    const Scene scene = read_scene_and_settle_threads(options.simulation, AskedThreads::exactly);
    const Variant& variant = require_variant(options.simulation.variant, scene, options.simulation.tuning,
                                             options.simulation.library);
    const std::string name = shown_name(options.simulation.scene);
    const Verdict verdict = options.trajectory.empty()
                                ? check_variant(name, options.simulation.tuning, scene, variant)
                                : check_file(options, scene, variant);
    if (options.json) {
        print_json(options, scene, variant, verdict);
    }
    if (verdict.violation) {
        throw CheckError(verdict.what + ", " + *verdict.violation);
    }
    if (!options.json) {
        print_line(scene, verdict);
    }
    if (options.trajectory.empty()) {
        note_crowding(options.simulation.tuning.threads);
        note_withheld_threads(options.simulation);
    }
}

} // namespace

void add_check_command(CLI::App& program) {
    auto options = std::make_shared<CheckOptions>();
    CLI::App* command = program.add_subcommand(
        "check",
        "Run, and verify every step with an independent checker (every collision of event_driven and "
        "at_contact); exit 2 at the first violation");
    add_simulation_options(*command, options->simulation);
    command->add_option(
        "--trajectory", options->trajectory,
        "Check the steps in this file instead, lines `step i x y vx vy` that any program may have "
        "written (gzip too); --variant says in which precision and with which impact. Only states are "
        "checked then, not collisions");
    command->add_flag(
        "--json", options->json,
        "Print the verdict as one JSON object, also of what fails, with the scope: every-collision, "
        "every-step or states");
    command->callback([options] { check(*options); });
}

} // namespace carom
