#pragma once

#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "harness/accuracy/choice.hpp"
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
    TrialResult result;
    ErrorBound bound;
    Trial trial;
};

/// Adds --error-below and --measure, beside which nobody may choose a variant or substeps.
void add_error_bound_options(CLI::App& command, ErrorBound& bound);

/// The cheapest method for the scene whose error is below the bound; nothing if there is no bound. Throws
/// InputError if no method is known to reach it, with the one that comes nearest, or if the scene has no
/// exact run: discs overlap at the start, or there is no unit of time.
std::optional<Chosen> choose_method(const Scene& scene, const ErrorBound& bound,
                                    const SimulationOptions& options);

/// Prints in two lines what was chosen, what error and cost it is expected to have, and from what.
void print_choice(const Chosen& chosen);

/// The same as the field `choice` of a summary.
nlohmann::ordered_json choice_json(const Chosen& chosen);

} // namespace carom
