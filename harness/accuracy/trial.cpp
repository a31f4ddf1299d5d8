#include "harness/accuracy/trial.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "harness/accuracy/companion.hpp"
#include "harness/accuracy/momentum_balance.hpp"
#include "harness/scenes/piece.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/verify/rounding.hpp"
#include "kernels/exact/event_driven.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

/// What the event-driven simulation may take of a trial; the others, which are given up as soon as they cost
/// more than the cheapest that will do, take some ten times as much together.
constexpr double seconds_of_one = 0.06;
constexpr double seconds_of_all = 0.8;

/// Of a trial of an average, which needs some units of time to become what it stays.
constexpr int fewest_units_of_average = 8;

/// Of timing those that will do: a trial is short, and whatever else runs can only lengthen it.
constexpr int further_rounds = 2;

/// Of the error of paths in a piece, which is not the scene.
constexpr double margin_of_piece = 0.25;

/// What a trial runs: the scene where it is small, or all of its run costs little, so that nothing of it is
/// left open; else a piece.
Scene scene_of_trial(const Scene& scene, Measure measure) {
    Scene piece = fullest_piece(scene, largest_trial(measure));
    if (measure == Measure::path || piece.discs.size() == scene.discs.size()) {
        return piece;
    }
    EventDriven<double> simulation(piece);
    const double before = process_seconds();
    simulation.advance(1);
    const double unit_seconds = (process_seconds() - before) * static_cast<double>(scene.discs.size()) /
                                static_cast<double>(piece.discs.size());
    return unit_seconds * scene.steps <= seconds_of_one ? scene : piece;
}

/// What a trial is of: fixed before a method runs.
struct TrialCase {
    double start; ///< of the trial, in seconds of the process
    const Scene& scene;
    const Tuning& tuning;
    Measure measure;
    double bound;
    Scene piece; ///< what runs: the scene itself, or a piece of it

    bool is_whole() const { return scene.discs.size() == piece.discs.size(); }

    /// How many times as many discs as the piece the scene has, and how many times as much of what is
    /// averaged.
    double times_larger() const {
        return static_cast<double>(scene.discs.size()) /
               static_cast<double>(std::max<std::size_t>(piece.discs.size(), 1));
    }
    double times_more() const {
        return measure == Measure::pressure ? scene.side / piece.side : times_larger();
    }

    bool is_out_of_time() const { return process_seconds() - start > seconds_of_all; }
};

/// What a method did in a trial.
struct Ran {
    std::vector<Disc> at_one;          ///< the state after one unit of time
    std::vector<double> amounts;       ///< of what the measure is the average of, in each unit of time
    double setting_up = 0;             ///< seconds
    std::vector<double> units_seconds; ///< of each unit of time

    /// Of the units of time after the first, which is also the first to touch its memory.
    double unit_seconds() const {
        std::vector<double> later(units_seconds.begin() + (units_seconds.size() > 1 ? 1 : 0),
                                  units_seconds.end());
        const auto middle = later.begin() + static_cast<std::ptrdiff_t>(later.size() / 2);
        std::ranges::nth_element(later, middle);
        return *middle;
    }
};

/// What the event-driven simulation did: the others are held against it.
struct ExactRun {
    Ran ran;
    int units = 1;    ///< of time, that each method runs
    double grain = 1; ///< of what is averaged
    double error = 0; ///< its own
};

void require_end(bool settled) {
    if (!settled) {
        throw CheckError("the collisions of one instant do not come to an end: a disc is wedged");
    }
}

/// What the measure is the average of, since the start.
template <class Real> double amount_of(const EventDriven<Real>& simulation, Measure measure) {
    return measure == Measure::pressure ? static_cast<double>(simulation.wall_impulse())
                                        : static_cast<double>(simulation.pair_collisions());
}

int affordable_units(const TrialCase& given, double unit_seconds) {
    const double fewest = given.measure == Measure::path ? 1 : fewest_units_of_average;
    const double affordable = std::floor(seconds_of_one / std::max(unit_seconds, 1e-9));
    return static_cast<int>(std::min(std::max(affordable, fewest), static_cast<double>(given.scene.steps)));
}

void advance_exactly(const TrialCase& given, int unit, EventDriven<double>& simulation, Ran& ran) {
    const double so_far = amount_of(simulation, given.measure);
    const double before = process_seconds();
    require_end(simulation.advance(unit));
    ran.units_seconds.push_back(process_seconds() - before);
    ran.amounts.push_back(amount_of(simulation, given.measure) - so_far);
    if (unit == 1) {
        ran.at_one = simulation.discs();
    }
}

/// What double rounds.
double own_error(const TrialCase& given, const ExactRun& exact) {
    EventDriven<long double> extended(given.piece);
    require_end(extended.advance(given.measure == Measure::path ? 1 : exact.units));
    if (given.measure == Measure::path) {
        return rms_distance(exact.ran.at_one, extended.discs(), given.piece.radius);
    }
    const double in_all = std::accumulate(exact.ran.amounts.begin(), exact.ran.amounts.end(), 0.0);
    return expected_average_error({.exact = {amount_of(extended, given.measure)}, .other = {in_all}}, 1)
        .error;
}

/// The first to run: it says how long a trial may be, and what nobody needs to exceed.
ExactRun run_exactly(const TrialCase& given) {
    ExactRun exact;
    const double before = process_seconds();
    EventDriven<double> simulation(given.piece);
    exact.ran.setting_up = process_seconds() - before;
    for (int unit = 1; unit <= exact.units; ++unit) {
        advance_exactly(given, unit, simulation, exact.ran);
        exact.units = unit == 1 ? affordable_units(given, exact.ran.units_seconds.front()) : exact.units;
    }
    if (given.measure == Measure::pressure) {
        exact.grain =
            grain_of_impulse(simulation.wall_impulse(), static_cast<double>(simulation.wall_collisions()));
    }
    exact.error = own_error(given, exact);
    return exact;
}

Expected error_of(const TrialCase& given, const ExactRun& exact, const Ran& ran) {
    if (given.measure != Measure::path) {
        return expected_average_error(
            {.exact = exact.ran.amounts, .other = ran.amounts, .grain = exact.grain}, given.scene.steps,
            given.times_more());
    }
    const double error = rms_distance(ran.at_one, exact.ran.at_one, given.piece.radius);
    return {.error = error, .margin = given.is_whole() ? 0 : margin_of_piece * error};
}

Tried tried_of(const TrialCase& given, const Method& method, const Ran& ran, const Expected& expected) {
    return {.method = method,
            .error = expected.error,
            .margin = expected.margin,
            .setting_up = given.times_larger() * ran.setting_up,
            .unit_seconds = given.times_larger() * ran.unit_seconds()};
}

/// Of the momentum that walls take up, which a step does not tell; none where nobody asks.
std::optional<MomentumWatch> watch_of(const TrialCase& given, const Method& method,
                                      const Simulation& simulation) {
    if (given.measure != Measure::pressure) {
        return std::nullopt;
    }
    const Policies& policies = method.variant->policies;
    return MomentumWatch(given.piece, rounding_of(policies), policies.impact, 1.0 / method.substeps,
                         simulation.discs());
}

/// A unit of time. False if a resolve did not end, or what it does to the walls cannot be told, or not in
/// time.
bool advance(const TrialCase& given, Simulation& simulation, int substeps,
             std::optional<MomentumWatch>& watch, Ran& ran) {
    double& amount = ran.amounts.emplace_back(0);
    double& seconds = ran.units_seconds.emplace_back(0);
    for (int substep = 0; substep < substeps; ++substep) {
        const double before = process_seconds();
        const Tally tally = simulation.step();
        seconds += process_seconds() - before;
        if (!tally.settled) {
            return false;
        }
        amount += watch ? watch->step(simulation.discs()) : static_cast<double>(tally.pair_resolves);
        if (watch && (watch->balance().from_wall_to_wall() || given.is_out_of_time())) {
            return false;
        }
    }
    if (ran.units_seconds.size() == 1) {
        ran.at_one = simulation.discs();
    }
    return true;
}

/// Nothing where a unit of time was not run to its end.
std::optional<Ran> run_method(const TrialCase& given, const ExactRun& exact, const Method& method) {
    Tuning tuning = given.tuning;
    tuning.substeps = method.substeps;
    const double before = process_seconds();
    const auto simulation = method.variant->simulate(given.piece, tuning);
    Ran ran;
    ran.setting_up = process_seconds() - before;
    auto watch = watch_of(given, method, *simulation);
    for (int unit = 1; unit <= exact.units; ++unit) {
        if (!advance(given, *simulation, method.substeps, watch, ran)) {
            return std::nullopt;
        }
        if (given.measure == Measure::path && error_of(given, exact, ran).error > given.bound) {
            break;
        }
    }
    return ran;
}

/// Whether more substeps of its variant are worth a trial.
bool try_method(const TrialCase& given, const ExactRun& exact, const Method& method,
                std::vector<Tried>& tried) {
    if (given.is_out_of_time()) {
        return false;
    }
    const auto ran = run_method(given, exact, method);
    if (!ran) {
        return false;
    }
    tried.push_back(tried_of(given, method, *ran, error_of(given, exact, *ran)));
    const auto cheapest = cheapest_below(tried, given.bound, given.scene.steps);
    return !cheapest || cheapest->cost(given.scene.steps) > tried.back().cost(given.scene.steps);
}

void time_again(const TrialCase& given, const ExactRun& exact, std::vector<Tried>& tried) {
    for (Tried& one : tried) {
        if (one.largest_error() > given.bound || given.is_out_of_time()) {
            continue;
        }
        if (const auto ran = run_method(given, exact, one.method)) {
            one.setting_up = std::min(one.setting_up, given.times_larger() * ran->setting_up);
            one.unit_seconds = std::min(one.unit_seconds, given.times_larger() * ran->unit_seconds());
        }
    }
}

} // namespace

Trial try_methods(const Scene& scene, const Tuning& tuning, Measure measure, double bound) {
    const TrialCase given{.start = process_seconds(),
                          .scene = scene,
                          .tuning = tuning,
                          .measure = measure,
                          .bound = bound,
                          .piece = scene_of_trial(scene, measure)};
    const ExactRun exact = run_exactly(given);
    std::vector<Tried> tried{
        tried_of(given, {.variant = &event_driven()}, exact.ran, {.error = exact.error})};
    std::vector<const Variant*> done{&event_driven()};
    for (const Method& method : methods_for(given.piece)) {
        const bool is_open = std::ranges::count(done, method.variant) == 0;
        if (is_open && !try_method(given, exact, method, tried)) {
            done.push_back(method.variant);
        }
    }
    for (int round = 0; round < further_rounds; ++round) {
        time_again(given, exact, tried);
    }
    return {.tried = std::move(tried),
            .discs = given.piece.discs.size(),
            .whole_scene = given.is_whole(),
            .units_of_time = exact.units,
            .seconds = process_seconds() - given.start};
}

} // namespace carom
