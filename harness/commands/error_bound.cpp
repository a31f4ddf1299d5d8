#include "harness/commands/error_bound.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "harness/command_line/values.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/json.hpp"
#include "harness/support/text.hpp"
#include "harness/verify/event_driven.hpp"

namespace carom {
namespace {

CLI::Validator positive_number() {
    const auto check = [](std::string& text) {
        const std::optional<double> value = parse_number<double>(text);
        const bool positive = value && *value > 0 && *value <= std::numeric_limits<double>::max();
        return positive ? std::string() : "found " + in_quotes(text) + ", expected a number above 0";
    };
    return {check, ""};
}

const char* word(Measure measure) { return measure == Measure::path ? "path" : "collision_rate"; }

const char* meaning(Measure measure) {
    return measure == Measure::path ? "RMS distance to the exact paths after one unit of time, in radii"
                                    : "relative error of the collision rate of the whole run";
}

std::string text_of(const Method& method) {
    const std::string name(method.variant->name);
    if (method.variant->policies.impact == Impact::event_driven) {
        return name;
    }
    return name + ", dt = " + (method.substeps == 1 ? "1" : "1/" + number_text(method.substeps));
}

/// "0.0034", or "0.0034 at most 0.0052" where the trial leaves something open.
std::string error_text(const Tried& tried) {
    return tried.margin > 0 ? format("%.2g, at most %.2g", tried.error, tried.largest_error())
                            : format("%.2g", tried.error);
}

} // namespace

void add_error_bound_options(CLI::App& command, ErrorBound& bound) {
    auto* below =
        command
            .add_option("--error-below", bound.below,
                        "Choose the cheapest variant and step whose error is below this, by a trial")
            ->check(positive_number())
            ->type_name("X")
            ->default_str("")
            ->excludes(command.get_option("--variant"))
            ->excludes(command.get_option("--substeps"));
    add_choice<Measure>(
        command, "--measure", bound.measure,
        {{word(Measure::path), Measure::path}, {word(Measure::collision_rate), Measure::collision_rate}},
        "Which error: of the paths at time 1, in radii, or of the collision rate, relative")
        ->needs(below);
}

std::optional<Chosen> choose_method(const Scene& scene, const ErrorBound& bound,
                                    const SimulationOptions& options) {
    if (bound.below == 0) {
        return std::nullopt;
    }
    const std::string option = "--error-below " + number_text(bound.below) + ": ";
    if (scene.steps == 0) {
        throw InputError(option + "found a scene of 0 steps, expected at least one");
    }
    if (const auto overlap = overlap_at_start(scene)) {
        throw InputError(
            option + "found that at the start " + *overlap +
            ": there is no exact run to measure an error by; expected discs apart from each other "
            "and from the walls");
    }
    Trial trial = try_methods(scene, options.tuning, bound.measure, bound.below);
    const auto cheapest = cheapest_below(trial.tried, bound.below, scene.steps);
    if (!cheapest) {
        const Tried& best = most_exact(trial.tried);
        throw InputError(option + "found no method with so small an error (" + meaning(bound.measure) +
                         "); the best is " + text_of(best.method) + ": " + error_text(best));
    }
    return Chosen{.tried = *cheapest, .bound = bound, .trial = std::move(trial)};
}

void print_choice(const Chosen& chosen) {
    const Trial& trial = chosen.trial;
    std::printf("chosen for an error below %s: %s; expected: %s (%s), %.3g ms a unit of time\n",
                number_text(chosen.bound.below).c_str(), text_of(chosen.tried.method).c_str(),
                error_text(chosen.tried).c_str(), meaning(chosen.bound.measure),
                1e3 * chosen.tried.unit_seconds);
    std::printf("from %s of at most %s of time on %s, against the event-driven simulation, in %.2g s\n",
                counted(trial.tried.size(), "trial").c_str(), counted(trial.units_of_time, "unit").c_str(),
                trial.whole_scene ? "the scene itself"
                                  : ("a piece of " + counted(trial.discs, "disc")).c_str(),
                trial.seconds);
}

nlohmann::ordered_json choice_json(const Chosen& chosen) {
    auto tried = nlohmann::ordered_json::array();
    for (const Tried& one : chosen.trial.tried) {
        tried.push_back({{"variant", one.method.variant->name},
                         {"substeps", one.method.substeps},
                         {"error", number_or_null(one.error)},
                         {"largest_error", number_or_null(one.largest_error())},
                         {"setting_up_seconds", one.setting_up},
                         {"unit_seconds", one.unit_seconds}});
    }
    return {{"error_below", chosen.bound.below},
            {"measure", word(chosen.bound.measure)},
            {"variant", chosen.tried.method.variant->name},
            {"substeps", chosen.tried.method.substeps},
            {"error", number_or_null(chosen.tried.error)},
            {"largest_error", number_or_null(chosen.tried.largest_error())},
            {"unit_seconds", chosen.tried.unit_seconds},
            {"trial",
             {{"seconds", chosen.trial.seconds},
              {"discs", chosen.trial.discs},
              {"whole_scene", chosen.trial.whole_scene},
              {"units_of_time", chosen.trial.units_of_time},
              {"tried", tried}}}};
}

} // namespace carom
