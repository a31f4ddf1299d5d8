#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "harness/accuracy/choice.hpp"
#include "harness/accuracy/trial.hpp"
#include "harness/commands/simulation_options.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// The error that a run may have.
struct ErrorBound {
    double below = 0; ///< 0: nobody asked
    Measure measure = Measure::path;
};

/// The method that was chosen for a bound, and what it was chosen from.
struct Chosen {
    Tried tried;
    ErrorBound bound;
    Trial trial;
};

/// The word for a measure on the command line and in records, and what it means.
struct MeasureText {
    Measure measure;
    const char* word;
    const char* meaning;
};

const MeasureText& text_of(Measure measure);

/// Every word with its measure.
std::vector<std::pair<std::string, Measure>> measure_choices();

/// The variant with the length of its step.
std::string text_of(const Method& method);

/// Throws InputError for a scene that has no exact run: whose discs overlap at the start, or without a unit
/// of time.
void require_exact_run(const Scene& scene, const ErrorBound& bound);

/// Adds --error-below and --measure, beside which nobody may choose a variant or substeps.
void add_error_bound_options(CLI::App& command, ErrorBound& bound);

/// The cheapest method for the scene whose error is below the bound; nothing if there is no bound. Throws
/// InputError if no method is known to reach it, with the one that comes nearest, and as require_exact_run.
std::optional<Chosen> choose_method(const Scene& scene, const ErrorBound& bound,
                                    const SimulationOptions& options);

/// Prints in two lines what was chosen, what error and cost it is expected to have, and from what.
void print_choice(const Chosen& chosen);

/// The same as the field `choice` of a summary.
nlohmann::ordered_json choice_json(const Chosen& chosen);

} // namespace carom
