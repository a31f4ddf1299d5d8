#include "harness/accuracy/choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "harness/scenes/piece.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/process_clock.hpp"
#include "variants/event_driven_variant.hpp"
#include "variants/fastest.hpp"
#include "variants/table.hpp"

namespace carom {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double count_of(const Scene& scene) { return static_cast<double>(scene.discs.size()); }

/// The mean of so high a power of the discs' speeds, in radii.
double mean_of_speeds(const Scene& scene, double power) {
    double sum = 0;
    for (const Disc& disc : scene.discs) {
        sum += std::pow(std::hypot(disc.vx, disc.vy) / scene.radius, power);
    }
    return sum / std::max(count_of(scene), 1.0);
}

/// What a trial is of: the beginning of a scene, or of the busiest piece of it.
struct Beginning {
    const Scene& scene;
    Measure measure;
    Piece part; ///< with as many units of time as each method runs

    Beginning(const Scene& whole, Measure its_measure) : scene(whole), measure(its_measure) {
        constexpr double most_of_average = 100'000; // discs times units of time
        constexpr double fewest_units = 8;          // in which an average becomes what it stays
        const bool is_path = measure == Measure::path;
        const bool is_short = !is_path && count_of(scene) * scene.steps <= most_of_average;
        part = busiest_piece(scene, is_short ? scene.discs.size() : largest_trial(measure));
        const double units = std::max(std::floor(most_of_average / count_of(part.scene)), fewest_units);
        part.scene.steps = is_path ? 1 : static_cast<int>(std::min<double>(units, scene.steps));
    }

    bool has_all_discs() const { return part.scene.discs.size() == scene.discs.size(); }

    /// Does the trial leave nothing open?
    bool is_all() const {
        return has_all_discs() && (measure == Measure::path || part.scene.steps == scene.steps);
    }
};

/// What one collision that is missed, or made in another order, adds to the sum of squared distances to the
/// exact paths within a unit of time: three discs fly on with a velocity that is off by what two of them
/// differ in, from some time of the unit on. Fast discs collide more often in proportion.
double moved_by_one_collision(const Scene& scene) {
    const double speed = mean_of_speeds(scene, 1);
    return speed > 0 ? 2 * mean_of_speeds(scene, 3) / speed : 0;
}

/// By how much the error of paths over all of a scene may be larger than in a piece.
double margin_of_paths(const Beginning& tried, double error) {
    const double moved = moved_by_one_collision(tried.scene);
    const double more = std::max(tried.part.whole_over_piece, 1.0);
    const double seen = count_of(tried.part.scene) * error * error;
    return std::sqrt(more * (seen + 2 * std::sqrt(seen * moved) + 3 * moved) / count_of(tried.part.scene)) -
           error;
}

/// The same of an average: twice the standard deviation of two numbers of collisions in the trial, and as
/// much again in the run. Momenta that a wall takes up have a mean square of 4 / pi times the square of their
/// mean where velocities are those of equilibrium (Maxwell 1860), and a mean of sqrt(pi) times the root of
/// the discs' mean square speed.
double margin_of_averages(const Beginning& tried, const AgainstReference& exact) {
    const Scene& scene = tried.part.scene;
    const double root_of_square = scene.radius * std::sqrt(mean_of_speeds(scene, 2));
    const double impulse = exact.pressure * scene.steps * 4 * scene.side;
    const double collisions =
        tried.measure == Measure::pressure
            ? impulse / (std::sqrt(std::numbers::pi) * root_of_square) / (4 / std::numbers::pi)
            : exact.collision_rate * scene.steps * count_of(scene);
    return collisions > 0 ? 2 * std::sqrt(4 / collisions) : infinity;
}

/// Nanoseconds of one thread in a scene of some ten thousand discs: of each disc and collision, with the
/// start shared out over the run.
double unit_seconds(const Scene& scene, const Method& method, double collision_rate) {
    const bool at_contact = method.variant->policies.impact == Impact::at_contact;
    double of_disc = 3.0 / scene.steps + 31.0 * method.substeps + (at_contact ? 75 : 20) * collision_rate;
    if (method.variant->engine == Engine::event_driven) {
        const double cell = std::max(2.0, scene.side / scene.radius / std::sqrt(count_of(scene) + 1));
        const double cells_crossed = 4 / std::numbers::pi * mean_of_speeds(scene, 1) / cell;
        of_disc = 150.0 / scene.steps + 150 * cells_crossed + 380 * collision_rate;
    }
    return 1e-9 * of_disc * count_of(scene);
}

TrialResult result_of(const Beginning& tried, const Tuning& tuning, const Method& method) {
    Tuning with_substeps = tuning;
    with_substeps.substeps = method.substeps;
    const ErrorMeasures errors = measure_errors(tried.part.scene, *method.variant, with_substeps);
    TrialResult result{.method = method,
                       .error = error_by(errors, tried.measure),
                       .unit_seconds = unit_seconds(tried.scene, method, errors.collision_rate.value_or(0))};
    if (!tried.is_all() && errors.reference) {
        const bool is_exact =
            method.variant->engine == Engine::event_driven; // but for what grows with numbers
        const double open = is_exact ? result.error * (tried.scene.side / tried.part.scene.side - 1)
                            : tried.measure == Measure::path ? margin_of_paths(tried, result.error)
                                                             : margin_of_averages(tried, *errors.reference);
        result.margin = std::max(open, result.error / 4);
    }
    return result;
}

/// A variant that does not bring every resolve to its end is left out from there on.
void try_substeps(const Beginning& tried, const Tuning& tuning, const Variant& variant, double bound,
                  std::vector<TrialResult>& results) {
    constexpr int most_substeps = 64;
    try {
        for (int substeps = 1; substeps <= most_substeps; substeps *= 2) {
            results.push_back(result_of(tried, tuning, {.variant = &variant, .substeps = substeps}));
            const TrialResult& last = results.back();
            if (last.largest_error() <= bound || last.unit_seconds > results.front().unit_seconds) {
                return;
            }
        }
    } catch (const CheckError&) {
    }
}

} // namespace

double error_by(const ErrorMeasures& errors, Measure measure) {
    if (!errors.reference) {
        return infinity;
    }
    const AgainstReference& exact = *errors.reference;
    if (measure == Measure::path) {
        return exact.trajectory.front().rms_distance;
    }
    const bool is_pressure = measure == Measure::pressure;
    const double found = (is_pressure ? errors.pressure : errors.collision_rate).value_or(infinity);
    const double expected = is_pressure ? exact.pressure : exact.collision_rate;
    return found == expected ? 0 : std::abs(found / expected - 1);
}

Trial try_methods(const Scene& scene, const Tuning& tuning, Measure measure, double bound) {
    const double start = process_seconds();
    const Beginning tried(scene, measure);
    std::vector<TrialResult> results{result_of(tried, tuning, {.variant = &event_driven()})};
    for (const Policies& policies : {at_contact(ladder.back()), fastest_variant(scene).policies}) {
        try_substeps(tried, tuning, *std::ranges::find(variants(), policies, &Variant::policies), bound,
                     results);
    }
    return {.results = std::move(results),
            .discs = tried.part.scene.discs.size(),
            .whole_scene = tried.has_all_discs(),
            .units_of_time = tried.part.scene.steps,
            .seconds = process_seconds() - start};
}

std::optional<TrialResult> cheapest_below(std::span<const TrialResult> results, double bound) {
    std::optional<TrialResult> cheapest;
    for (const TrialResult& one : results) {
        if (one.largest_error() <= bound && (!cheapest || one.unit_seconds < cheapest->unit_seconds)) {
            cheapest = one;
        }
    }
    return cheapest;
}

const TrialResult& most_exact(std::span<const TrialResult> results) {
    return *std::ranges::min_element(results, {}, &TrialResult::largest_error);
}

} // namespace carom
