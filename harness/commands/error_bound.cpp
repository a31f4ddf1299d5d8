#include "harness/commands/error_bound.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "harness/command_line/values.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/json.hpp"
#include "harness/support/text.hpp"
#include "harness/verify/event_driven_violation.hpp"

namespace carom {
namespace {

/// The word for a measure on the command line and in summaries, and what it means.
struct MeasureText {
    Measure measure;
    const char* word;
    const char* meaning;
};

constexpr std::array measure_texts{
    MeasureText{Measure::path, "path", "RMS distance to the exact paths after one unit of time, in radii"},
    MeasureText{Measure::collision_rate, "collision_rate",
                "relative error of the collision rate of the whole run"},
    MeasureText{Measure::pressure, "pressure",
                "relative error of the pressure on the walls over the whole run"},
};

std::string option_text(const ErrorBound& bound) {
    return "--error-below " + number_text(bound.below) + ": ";
}

/// "0.0034", or "0.0034 at most 0.0052" where the trial leaves something open.
std::string error_text(const TrialResult& result) {
    return result.margin > 0 ? format("%.2g, at most %.2g", result.error, result.largest_error())
                             : format("%.2g", result.error);
}

const MeasureText& text_of(Measure measure) {
    return *std::ranges::find(measure_texts, measure, &MeasureText::measure);
}

/// The variant with the length of its step.
std::string text_of(const Method& method) {
    const std::string name(method.variant->name);
    if (method.variant->engine == Engine::event_driven) {
        return name;
    }
    return name + ", dt = " + (method.substeps == 1 ? "1" : "1/" + number_text(method.substeps));
}

void require_exact_run(const Scene& scene, const ErrorBound& bound) {
    if (scene.steps == 0) {
        throw InputError(option_text(bound) + "found a scene of 0 steps, expected at least one");
    }
    if (const auto overlap = overlap_at_start(scene)) {
        throw InputError(
            option_text(bound) + "found that at the start " + *overlap +
            ": there is no exact run to measure an error by; expected discs apart from each other "
            "and from the walls");
    }
}

} // namespace

void add_error_bound_options(CLI::App& command, ErrorBound& bound) {
    std::vector<std::pair<std::string, Measure>> measures;
    for (const MeasureText& one : measure_texts) {
        measures.emplace_back(one.word, one.measure);
    }
    auto* below =
        command
            .add_option("--error-below", bound.below,
                        "Choose the cheapest variant and step whose error is below this, by a trial")
            ->check(positive_number())
            ->type_name("X")
            ->default_str("")
            ->excludes(command.get_option("--variant"))
            ->excludes(command.get_option("--substeps"));
    add_choice<Measure>(command, "--measure", bound.measure, measures,
                        "Which error: of the paths at time 1, in radii, or of the collision rate or the "
                        "pressure, relative")
        ->needs(below);
}

std::optional<Chosen> choose_method(const Scene& scene, const ErrorBound& bound,
                                    const SimulationOptions& options) {
    if (bound.below == 0) {
        return std::nullopt;
    }
    require_exact_run(scene, bound);
    const std::string option = option_text(bound);
    Trial trial = try_methods(scene, options.tuning, bound.measure, bound.below);
    const auto cheapest = cheapest_below(trial.results, bound.below);
    if (!cheapest) {
        const TrialResult& best = most_exact(trial.results);
        throw InputError(option + "found no method with so small an error (" +
                         text_of(bound.measure).meaning + "); the best is " + text_of(best.method) + ": " +
                         error_text(best));
    }
    return Chosen{.result = *cheapest, .bound = bound, .trial = std::move(trial)};
}

void print_choice(const Chosen& chosen) {
    const Trial& trial = chosen.trial;
    std::printf("chosen for an error below %s: %s; expected: %s (%s), %.3g ms a unit of time on one thread\n",
                number_text(chosen.bound.below).c_str(), text_of(chosen.result.method).c_str(),
                error_text(chosen.result).c_str(), text_of(chosen.bound.measure).meaning,
                1e3 * chosen.result.unit_seconds);
    std::printf("from %s of at most %s of time on %s, against the event-driven simulation, in %.2g s\n",
                counted(trial.results.size(), "trial").c_str(), counted(trial.units_of_time, "unit").c_str(),
                trial.whole_scene ? "the scene itself"
                                  : ("a piece of " + counted(trial.discs, "disc")).c_str(),
                trial.seconds);
}

nlohmann::ordered_json choice_json(const Chosen& chosen) {
    const auto row = [](const TrialResult& one) {
        return nlohmann::ordered_json{{"variant", one.method.variant->name},
                                      {"substeps", one.method.substeps},
                                      {"error", number_or_null(one.error)},
                                      {"largest_error", number_or_null(one.largest_error())},
                                      {"unit_seconds", one.unit_seconds}};
    };
    auto tried = nlohmann::ordered_json::array();
    std::ranges::transform(chosen.trial.results, std::back_inserter(tried), row);
    nlohmann::ordered_json json{{"error_below", chosen.bound.below},
                                {"measure", text_of(chosen.bound.measure).word}};
    json.update(row(chosen.result));
    json["trial"] = {{"seconds", chosen.trial.seconds},
                     {"discs", chosen.trial.discs},
                     {"whole_scene", chosen.trial.whole_scene},
                     {"units_of_time", chosen.trial.units_of_time},
                     {"tried", tried}};
    return json;
}

} // namespace carom
