#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "harness/collisions/path_checker.hpp"
#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/measurement_options.hpp"
#include "harness/machine/threads.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/text.hpp"
#include "harness/verify/checker.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

struct ReferenceOptions {
    std::string scene;
    std::string output;
    double time = 0;
    int threads = 1;
    bool extended = false;
    bool check = false;
    bool json = false;
};

/// Pressure on the walls: momentum taken up per time and length of wall.
template <class Real, class Log>
nlohmann::ordered_json counts_json(const ExactSimulation<Real, Log>& reference, const Scene& scene,
                                   Real start) {
    const Real end = kinetic_energy(reference.discs());
    const auto time = static_cast<double>(reference.time());
    const auto impulse = static_cast<double>(reference.wall_impulse());
    const auto if_above_0 = [](auto whole, auto value) {
        return whole > 0 ? nlohmann::ordered_json(static_cast<double>(value / whole)) : nullptr;
    };
    return {{"time", time},
            {"particles", scene.discs.size()},
            {"pair_collisions", reference.pair_collisions()},
            {"wall_collisions", reference.wall_collisions()},
            {"wall_impulse", impulse},
            {"pressure", if_above_0(time * 4 * scene.side, impulse)},
            {"energy_drift", if_above_0(start, end - start)}};
}

/// Writes what `reference` is at the asked time, which `checker` has followed if there is one.
template <class Real, class Log>
void simulate(const ReferenceOptions& options, const Scene& scene, ExactSimulation<Real, Log> reference,
              PathChecker<Real>* checker) {
    const Real start = kinetic_energy(reference.discs());
    const bool ended = reference.advance(static_cast<Real>(options.time));
    const auto wrong = checker ? checker->violation_at(reference.time(), reference.discs()) : std::nullopt;
    if (wrong) {
        throw CheckError(shown_name(options.scene) + ", " + *wrong);
    }
    if (!ended) {
        throw CheckError(shown_name(options.scene) + ": the collisions at time " +
                         number_text(static_cast<double>(reference.time())) +
                         " do not come to an end: a disc is wedged");
    }
    if (!options.json) {
        write_text(options.output, disc_lines(reference.discs()));
        return;
    }
    auto json = counts_json(reference, scene, start);
    json["check"] = checker ? nlohmann::ordered_json("passed") : nullptr;
    write_text(options.output, json.dump(2) + "\n");
}

/// Collisions are told only to a checker: several threads tell them one after the other, which takes time.
template <class Real> void simulate(const ReferenceOptions& options, const Scene& scene) {
    if (!options.check) {
        simulate<Real>(options, scene, ExactSimulation<Real>(scene, options.threads), nullptr);
        return;
    }
    PathChecker<Real> checker(scene);
    CollisionLog<Real>& told = checker;
    simulate<Real>(options, scene, ExactSimulation<Real, CollisionLog<Real>&>(scene, options.threads, told),
                   &checker);
}

void reference(const ReferenceOptions& options) {
    require_writable(options.output);
    const Scene scene = read_scene(options.scene);
    if (options.extended) {
        simulate<long double>(options, scene);
    } else {
        simulate<double>(options, scene);
    }
}

} // namespace

void add_reference_command(CLI::App& program) {
    auto options = std::make_shared<ReferenceOptions>();
    CLI::App* command = program.add_subcommand(
        "reference", "Simulate exactly, event by event, and print `i x y vx vy` for every disc");
    add_scene_option(*command, options->scene);
    add_number(*command, "--time", options->time, 0.0, largest_number, "Time at which to print the state")
        ->required()
        ->default_str("");
    add_number(*command, "--threads", options->threads, 1, most_threads, "Threads; the result is the same")
        ->default_str("1");
    command->add_flag("--extended", options->extended, "Compute in long double instead of double");
    command->add_flag("--check", options->check,
                      "Follow every collision with an independent checker; exit 2 at the first violation");
    command->add_option("--output", options->output, "File to write instead of standard output");
    command->add_flag("--json", options->json, "Print collision counts, wall impulse and pressure instead");
    command->callback([options] { reference(*options); });
}

} // namespace carom
