#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "harness/collisions/path_checker.hpp"
#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/text.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

struct ReferenceOptions {
    std::string scene;
    std::string output;
    double time = 0;
    bool extended = false;
    bool check = false;
    bool json = false;
};

template <class Real> std::string disc_lines(const std::vector<BasicDisc<Real>>& discs) {
    std::string text;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        append_disc(text, i, discs[i]);
    }
    return text;
}

template <class Real> Real speeds_squared(const std::vector<BasicDisc<Real>>& discs) {
    Real sum = 0;
    for (const auto& disc : discs) {
        sum += disc.vx * disc.vx + disc.vy * disc.vy;
    }
    return sum;
}

/// Pressure on the walls: momentum taken up per time and length of wall.
template <class Real, class Log>
nlohmann::ordered_json counts_json(const EventDriven<Real, Log>& reference, const Scene& scene, Real start) {
    const Real end = speeds_squared(reference.discs());
    const auto time = static_cast<double>(reference.time());
    const auto impulse = static_cast<double>(reference.wall_impulse());
    nlohmann::ordered_json json{{"time", time},
                                {"particles", scene.discs.size()},
                                {"pair_collisions", reference.pair_collisions()},
                                {"wall_collisions", reference.wall_collisions()},
                                {"wall_impulse", impulse},
                                {"pressure", nullptr},
                                {"energy_drift", nullptr}};
    if (time > 0) {
        json["pressure"] = impulse / (time * 4 * scene.side);
    }
    if (start > 0) {
        json["energy_drift"] = static_cast<double>((end - start) / start);
    }
    return json;
}

/// Goes on to the end and writes what was asked for. `violation` is asked for the first that was wrong then.
template <class Real, class Log, class Violation>
void finish(EventDriven<Real, Log> reference, const ReferenceOptions& options, const Scene& scene,
            const Violation& violation) {
    const Real start = speeds_squared(reference.discs());
    const bool ended = reference.advance(static_cast<Real>(options.time));
    if (const std::optional<std::string> wrong = violation(reference)) {
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
    json["check"] = options.check ? nlohmann::ordered_json("passed") : nullptr;
    write_text(options.output, json.dump(2) + "\n");
}

template <class Real> void simulate(const ReferenceOptions& options, const Scene& scene) {
    if (!options.check) {
        finish(EventDriven<Real>(scene), options, scene, [](const auto&) { return std::nullopt; });
        return;
    }
    PathChecker<Real> checker(scene);
    finish(EventDriven<Real, CollisionLog<Real>&>(scene, checker), options, scene,
           [&](const auto& reference) { return checker.violation_at(reference.time(), reference.discs()); });
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
    command->add_option("SCENE", options->scene, "Scene file; - is standard input")->required();
    add_number(*command, "--time", options->time, 0.0, largest_number, "Time at which to print the state")
        ->required()
        ->default_str("");
    command->add_flag("--extended", options->extended, "Compute in long double instead of double");
    command->add_flag("--check", options->check,
                      "Follow every collision with an independent checker; exit 2 at the first violation");
    command->add_option("--output", options->output, "File to write instead of standard output");
    command->add_flag("--json", options->json, "Print collision counts, wall impulse and pressure instead");
    command->callback([options] { reference(*options); });
}

} // namespace carom
