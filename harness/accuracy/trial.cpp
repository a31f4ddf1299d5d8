#include "harness/accuracy/trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

#include "harness/accuracy/companion.hpp"
#include "harness/accuracy/costs.hpp"
#include "harness/accuracy/momentum_balance.hpp"
#include "harness/scenes/piece.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/process_clock.hpp"
#include "kernels/exact/event_driven.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

/// Of an average, which needs some units of time to become what it stays: so many discs and collisions in
/// all, of the scene itself where its run has no more.
constexpr double most_of_average = 100'000;
constexpr int fewest_units_of_average = 8;

/// Seconds of work after which no other method is tried.
constexpr double seconds_of_all = 0.8;

/// What a trial is of.
struct TrialCase {
    const Scene& scene;
    const Tuning& tuning;
    Measure measure;
    Piece part; ///< what runs: the scene itself, or a piece of it

    const Scene& piece() const { return part.scene; }
    bool is_whole() const { return scene.discs.size() == piece().discs.size(); }

    /// How many times as many discs as the piece the scene has, and how many times as much of what is
    /// averaged.
    double times_larger() const {
        return static_cast<double>(scene.discs.size()) /
               static_cast<double>(std::max<std::size_t>(piece().discs.size(), 1));
    }
    double times_more() const {
        return measure == Measure::pressure ? scene.side / piece().side : times_larger();
    }
};

/// What a method did in it.
struct TrialRun {
    std::vector<Disc> at_one;    ///< the state after one unit of time
    std::vector<double> amounts; ///< of what the measure is the average of, in each unit of time
    double seconds = 0;          ///< that the work of all units of time costs
};

/// What the event-driven simulation did: the others are held against it.
struct ExactRun {
    TrialRun run;
    double grain = 1; ///< of what is averaged
    double error = 0; ///< its own
};

Piece part_of(const Scene& scene, Measure measure) {
    const double all = static_cast<double>(scene.discs.size()) * scene.steps;
    return measure != Measure::path && all <= most_of_average ? Piece{.scene = scene}
                                                              : busiest_piece(scene, largest_trial(measure));
}

void require_end(bool settled) {
    if (!settled) {
        throw CheckError("the collisions of one instant do not come to an end: a disc is wedged");
    }
}

template <class Real> std::int64_t collisions_of(const EventDriven<Real>& simulation) {
    return simulation.pair_collisions() + simulation.wall_collisions();
}

/// What the measure is the average of, since the start.
template <class Real> double amount_of(const EventDriven<Real>& simulation, Measure measure) {
    return measure == Measure::pressure ? static_cast<double>(simulation.wall_impulse())
                                        : static_cast<double>(simulation.pair_collisions());
}

/// Units of time of a trial, of which one makes so many collisions.
int units_of(const TrialCase& given, std::int64_t collisions) {
    const double one = static_cast<double>(given.piece().discs.size()) + static_cast<double>(collisions) + 1;
    const double most = std::max(std::floor(most_of_average / one), double{fewest_units_of_average});
    return given.measure == Measure::path ? 1 : static_cast<int>(std::min<double>(most, given.scene.steps));
}

/// What double rounds of a run of so many units of time.
double own_error(const TrialCase& given, const TrialRun& run) {
    EventDriven<long double> extended(given.piece());
    require_end(extended.advance(static_cast<long double>(run.amounts.size())));
    if (given.measure == Measure::path) {
        // Numbers are the larger in the scene, and so is what double rounds of them.
        const double times_wider = given.scene.side / given.piece().side;
        return times_wider * rms_distance(run.at_one, extended.discs(), given.piece().radius);
    }
    const double in_all = std::accumulate(run.amounts.begin(), run.amounts.end(), 0.0);
    return expected_average_error({.exact = {amount_of(extended, given.measure)}, .other = {in_all}}, 1)
        .error;
}

/// The first to run: it says how long a trial may be.
ExactRun run_exactly(const TrialCase& given) {
    const Costs costs(event_driven(), given.scene.discs.size());
    ExactRun exact;
    EventDriven<double> simulation(given.piece());
    int units = 1;
    for (int unit = 1; unit <= units; ++unit) {
        const double so_far = amount_of(simulation, given.measure);
        require_end(simulation.advance(unit));
        exact.run.seconds += costs.step(given.piece());
        exact.run.amounts.push_back(amount_of(simulation, given.measure) - so_far);
        if (unit == 1) {
            exact.run.at_one = simulation.discs();
            units = units_of(given, collisions_of(simulation));
        }
    }
    exact.run.seconds += costs.collisions(collisions_of(simulation));
    if (given.measure == Measure::pressure) {
        exact.grain =
            grain_of_impulse(simulation.wall_impulse(), static_cast<double>(simulation.wall_collisions()));
    }
    exact.error = own_error(given, exact.run);
    return exact;
}

/// Nothing if a resolve did not end, or what it does to the walls cannot be told.
std::optional<TrialRun> run_method(const TrialCase& given, const Method& method, std::size_t units) {
    Tuning tuning = given.tuning;
    tuning.substeps = method.substeps;
    const Policies& policies = method.variant->policies;
    const Costs costs(*method.variant, given.scene.discs.size());
    const auto simulation = method.variant->simulate(given.piece(), tuning);
    Scene now = given.piece();
    std::optional<MomentumWatch> watch; // of the momentum that walls take up, which a step does not tell
    if (given.measure == Measure::pressure) {
        watch.emplace(given.piece(), rounding_of(policies), policies.impact, 1.0 / method.substeps,
                      simulation->discs());
    }
    TrialRun run;
    while (run.amounts.size() < units) {
        now.discs = simulation->discs();
        run.seconds += method.substeps * costs.step(now);
        double& amount = run.amounts.emplace_back(0);
        for (int substep = 0; substep < method.substeps; ++substep) {
            const Tally tally = simulation->step();
            run.seconds += costs.collisions(tally.pair_resolves + tally.wall_resolves);
            amount += watch ? watch->step(simulation->discs()) : static_cast<double>(tally.pair_resolves);
            if (!tally.settled || (watch && watch->balance().from_wall_to_wall())) {
                return std::nullopt;
            }
        }
        if (run.amounts.size() == 1) {
            run.at_one = simulation->discs();
        }
    }
    return run;
}

Expected error_of(const TrialCase& given, const ExactRun& exact, const TrialRun& run) {
    if (given.measure != Measure::path) {
        return expected_average_error(
            {.exact = exact.run.amounts, .other = run.amounts, .grain = exact.grain}, given.scene.steps,
            given.times_more());
    }
    const auto squares = squared_distances(run.at_one, exact.run.at_one, given.piece().radius);
    const double moved = given.is_whole() ? 0 : moved_by_one_collision(given.scene);
    const Expected expected = expected_path_error(squares, moved, given.part.whole_over_piece);
    return given.is_whole() ? Expected{.error = expected.error} : expected;
}

Tried tried_of(const TrialCase& given, const Method& method, const TrialRun& run, const Expected& expected) {
    return {.method = method,
            .error = expected.error,
            .margin = expected.margin,
            .setting_up = Costs(*method.variant, given.scene.discs.size()).setting_up(given.scene),
            .unit_seconds = given.times_larger() * run.seconds / static_cast<double>(run.amounts.size())};
}

} // namespace

Trial try_methods(const Scene& scene, const Tuning& tuning, Measure measure, double bound) {
    const double start = process_seconds();
    const TrialCase given{
        .scene = scene, .tuning = tuning, .measure = measure, .part = part_of(scene, measure)};
    const ExactRun exact = run_exactly(given);
    const double margin = given.is_whole() ? 0 : least_margin_of_piece * exact.error;
    std::vector<Tried> tried{
        tried_of(given, {.variant = &event_driven()}, exact.run, {.error = exact.error, .margin = margin})};
    std::vector<const Variant*> done{&event_driven()};
    const double of_watching = measure == Measure::pressure ? 4 : 1; // times as much as a step
    double spent = 4 * exact.run.seconds;                            // long double takes three times as much
    for (const Method& method : methods_for(scene)) {
        if (std::ranges::count(done, method.variant) > 0 || spent > seconds_of_all) {
            continue;
        }
        const auto run = run_method(given, method, exact.run.amounts.size());
        if (run) {
            spent += of_watching * run->seconds;
            tried.push_back(tried_of(given, method, *run, error_of(given, exact, *run)));
        }
        const auto cheapest = cheapest_below(tried, bound, scene.steps);
        if (!run || (cheapest && cheapest->cost(scene.steps) <= tried.back().cost(scene.steps))) {
            done.push_back(method.variant); // more substeps of it are not worth a trial
        }
    }
    return {.tried = std::move(tried),
            .discs = given.piece().discs.size(),
            .whole_scene = given.is_whole(),
            .units_of_time = static_cast<int>(exact.run.amounts.size()),
            .seconds = process_seconds() - start};
}

} // namespace carom
