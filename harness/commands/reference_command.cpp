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
    bool check = false;
    bool json = false;
};

/// Pressure on the walls: momentum taken up per time and length of wall.
nlohmann::ordered_json counts_json(const ExactSimulation<double>& reference, const Scene& scene,
                                   double start) {
    const double end = kinetic_energy(reference.discs());
    const double time = reference.time();
    const double impulse = reference.wall_impulse();
    const auto if_above_0 = [](double whole, double value) {
        return whole > 0 ? nlohmann::ordered_json(value / whole) : nullptr;
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
template <class Exact>
void simulate(const ReferenceOptions& options, const Scene& scene, Exact reference, PathChecker* checker) {
    const double start = kinetic_energy(reference.discs());
    const bool ended = reference.advance(options.time);
    const auto wrong = checker ? checker->violation_at(reference.time(), reference.discs()) : std::nullopt;
    if (wrong) {
        throw CheckError(shown_name(options.scene) + ", " + *wrong);
    }
    if (!ended) {
        throw CheckError(shown_name(options.scene) + ": the collisions at time " +
                         number_text(reference.time()) + " do not come to an end: a disc is wedged");
    }
    if (!options.json) {
        write_text(options.output, disc_lines(reference.discs()));
        return;
    }
    auto json = counts_json(reference, scene, start);
    json["check"] = checker ? nlohmann::ordered_json("passed") : nullptr;
    write_text(options.output, json.dump(2) + "\n");
}

/// Collisions are told only to a checker: for that the simulation goes along in one piece, too.
void reference(const ReferenceOptions& options) {
    const Scene scene = read_scene(options.scene);
    if (!options.check) {
        simulate(options, scene, ExactSimulation<double>(scene, options.threads), nullptr);
        return;
    }
    PathChecker checker(scene);
    simulate(options, scene, ToldSimulation(scene, options.threads, checker), &checker);
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
    command->add_flag("--check", options->check,
                      "Follow every collision with an independent checker; exit 2 at the first violation");
    command->add_option("--output", options->output, "File to write instead of standard output")
        ->check(writable());
    command->add_flag("--json", options->json, "Print collision counts, wall impulse and pressure instead");
    command->callback([options] { reference(*options); });
}

} // namespace carom
