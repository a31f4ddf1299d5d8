#include "harness/accuracy/trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "harness/accuracy/companion.hpp"
#include "harness/accuracy/method_run.hpp"
#include "harness/scenes/piece.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/process_clock.hpp"
#include "kernels/exact/event_driven.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

/// What the event-driven simulation may cost in a trial; the others, which are given up as soon as they cost
/// more than the cheapest that will do, cost some ten times as much together.
constexpr double seconds_of_one = 0.06;
constexpr double seconds_of_all = 0.8;

/// Of a trial of an average, which needs some units of time to become what it stays.
constexpr int fewest_units_of_average = 8;

/// The work of a unit of time of the event-driven simulation that made so many collisions in it.
Work exact_work(const Scene& scene, double collisions) {
    Work work = work_of_events(scene);
    work.collisions = collisions;
    return work;
}

/// What a trial runs: the scene where it is small, or all of its run costs little, so that nothing of it is
/// left open; else a piece.
Piece scene_of_trial(const Scene& scene, Measure measure) {
    Piece found = busiest_piece(scene, largest_trial(measure));
    const Scene& piece = found.scene;
    if (measure == Measure::path || piece.discs.size() == scene.discs.size()) {
        return found;
    }
    EventDriven<double> simulation(piece);
    simulation.advance(1);
    const auto discs = static_cast<double>(scene.discs.size());
    const Work work =
        discs / static_cast<double>(piece.discs.size()) *
        exact_work(piece, static_cast<double>(simulation.pair_collisions() + simulation.wall_collisions()));
    return seconds_of(event_driven(), discs, work) * scene.steps <= seconds_of_one ? Piece{.scene = scene}
                                                                                   : found;
}

/// What the event-driven simulation did: the others are held against it.
struct ExactRun {
    Ran ran;
    int units = 1;    ///< of time, that each method runs
    double grain = 1; ///< of what is averaged
    double error = 0; ///< its own
    double moved = 0; ///< by one collision that another method has not (moved_by_one_collision)
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
    const std::int64_t collisions = simulation.pair_collisions() + simulation.wall_collisions();
    require_end(simulation.advance(unit));
    ran.work += exact_work(given.piece, static_cast<double>(simulation.pair_collisions() +
                                                            simulation.wall_collisions() - collisions));
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
        // Numbers are the larger in the scene, and so is what double rounds of them.
        const double times_wider = given.scene.side / given.piece.side;
        return times_wider * rms_distance(exact.ran.at_one, extended.discs(), given.piece.radius);
    }
    const double in_all = std::accumulate(exact.ran.amounts.begin(), exact.ran.amounts.end(), 0.0);
    return expected_average_error({.exact = {amount_of(extended, given.measure)}, .other = {in_all}}, 1)
        .error;
}

/// The first to run: it says how long a trial may be, and what nobody needs to exceed.
ExactRun run_exactly(const TrialCase& given) {
    ExactRun exact;
    const Method method{.variant = &event_driven()};
    EventDriven<double> simulation(given.piece);
    for (int unit = 1; unit <= exact.units; ++unit) {
        advance_exactly(given, unit, simulation, exact.ran);
        exact.units =
            unit == 1 ? affordable_units(given, given.seconds(method, exact.ran.work)) : exact.units;
    }
    if (given.measure == Measure::pressure) {
        exact.grain =
            grain_of_impulse(simulation.wall_impulse(), static_cast<double>(simulation.wall_collisions()));
    }
    exact.error = own_error(given, exact);
    exact.moved = given.is_whole() ? 0 : moved_by_one_collision(given.scene);
    constexpr double in_long_double = 3; // times as much as in double, about
    exact.ran.seconds = (1 + in_long_double) *
                        (given.seconds(method, given.placed()) + given.seconds(method, exact.ran.work));
    return exact;
}

Expected error_of(const TrialCase& given, const ExactRun& exact, const Ran& ran) {
    if (given.measure != Measure::path) {
        return expected_average_error(
            {.exact = exact.ran.amounts, .other = ran.amounts, .grain = exact.grain}, given.scene.steps,
            given.times_more());
    }
    const auto squares = squared_distances(ran.at_one, exact.ran.at_one, given.piece.radius);
    const Expected expected = expected_path_error(squares, exact.moved, given.whole_over_piece);
    return given.is_whole() ? Expected{.error = expected.error} : expected;
}

Tried tried_of(const TrialCase& given, const Method& method, const Ran& ran, const Expected& expected) {
    const Work unit = 1.0 / static_cast<double>(ran.amounts.size()) * ran.work;
    return {.method = method,
            .error = expected.error,
            .margin = expected.margin,
            .setting_up = given.seconds_of_scene(method, given.placed()),
            .unit_seconds = given.seconds_of_scene(method, unit)};
}

/// All methods on the case, until enough is known.
class Trials {
  public:
    explicit Trials(const TrialCase& given) : given_(given), exact_(run_exactly(given)) {
        spent_ = exact_.ran.seconds;
        const double margin = given.is_whole() ? 0 : least_margin_of_piece * exact_.error;
        tried_.push_back(tried_of(given, {.variant = &event_driven()}, exact_.ran,
                                  {.error = exact_.error, .margin = margin}));
    }

    /// Whether more substeps of its variant are worth a trial.
    bool run(const Method& method) {
        if (spent_ > seconds_of_all) {
            return false;
        }
        MethodRun run(given_, method, seconds_of_all - spent_);
        const bool ended = run_units(run);
        spent_ += run.ran().seconds;
        if (!ended) {
            return false;
        }
        tried_.push_back(tried_of(given_, method, run.ran(), error_of(given_, exact_, run.ran())));
        const auto cheapest = cheapest_below(tried_, given_.bound, given_.scene.steps);
        return !cheapest || cheapest->cost(given_.scene.steps) > tried_.back().cost(given_.scene.steps);
    }

    int units() const { return exact_.units; }
    std::vector<Tried>& tried() { return tried_; }

  private:
    /// False where a unit of time was not run to its end.
    bool run_units(MethodRun& run) const {
        for (int unit = 1; unit <= exact_.units; ++unit) {
            if (!run.advance()) {
                return false;
            }
            if (given_.measure == Measure::path && path_error_is_too_large(run.ran())) {
                break;
            }
        }
        return true;
    }

    bool path_error_is_too_large(const Ran& ran) const {
        const Expected expected = error_of(given_, exact_, ran);
        return expected.error + expected.margin > given_.bound;
    }

    const TrialCase& given_;
    ExactRun exact_;
    double spent_ = 0; ///< seconds that it costs so far
    std::vector<Tried> tried_;
};

} // namespace

Trial try_methods(const Scene& scene, const Tuning& tuning, Measure measure, double bound) {
    const double start = process_seconds();
    Piece piece = scene_of_trial(scene, measure);
    const TrialCase given{.scene = scene,
                          .tuning = tuning,
                          .measure = measure,
                          .bound = bound,
                          .piece = std::move(piece.scene),
                          .whole_over_piece = piece.whole_over_piece};
    Trials trials(given);
    std::vector<const Variant*> done{&event_driven()};
    for (const Method& method : methods_for(given.scene)) {
        const bool is_open = std::ranges::count(done, method.variant) == 0;
        if (is_open && !trials.run(method)) {
            done.push_back(method.variant);
        }
    }
    return {.tried = std::move(trials.tried()),
            .discs = given.piece.discs.size(),
            .whole_scene = given.is_whole(),
            .units_of_time = trials.units(),
            .seconds = process_seconds() - start};
}

} // namespace carom
