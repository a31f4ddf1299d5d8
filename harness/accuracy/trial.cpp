#include "harness/accuracy/trial.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "harness/accuracy/companion.hpp"
#include "harness/accuracy/momentum_watch.hpp"
#include "harness/scenes/piece.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/verify/rounding.hpp"
#include "kernels/exact/event_driven.hpp"
#include "variants/event_driven_variant.hpp"
#include "variants/fastest.hpp"
#include "variants/table.hpp"

namespace carom {
namespace {

/// What the event-driven simulation may take of a trial; the others, which are given up as soon as they cost
/// more than the cheapest that will do, take some ten times as much together.
constexpr double seconds_of_one = 0.06;
constexpr double seconds_of_all = 0.8;
constexpr int most_substeps = 64;

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

/// Every variant that may be the cheapest: the fastest with either impact, in either precision that holds the
/// scene. First those that reach a bound with fewer steps, since they say how far the others need to go.
std::vector<const Variant*> candidates(const Scene& scene) {
    std::vector<const Variant*> found;
    for (const Policies& base : {at_contact(ladder.back()), fastest_variant(scene).policies}) {
        for (const Precision precision : {Precision::double_, Precision::float_}) {
            Policies wanted = base;
            wanted.precision = precision;
            const auto variant = std::ranges::find(variants(), wanted, &Variant::policies);
            if (variant != variants().end() && holds(wanted, scene)) {
                found.push_back(&*variant);
            }
        }
    }
    return found;
}

class Trying {
  public:
    Trying(const Scene& scene, const Tuning& tuning, Measure measure, double bound)
        : piece_(scene_of_trial(scene, measure)), tuning_(tuning), measure_(measure), bound_(bound),
          units_of_run_(scene.steps), is_whole_(scene.discs.size() == piece_.discs.size()),
          times_larger_(static_cast<double>(scene.discs.size()) /
                        static_cast<double>(std::max<std::size_t>(piece_.discs.size(), 1))),
          times_more_(measure == Measure::pressure ? scene.side / piece_.side : times_larger_),
          extended_(piece_) {}

    Trial run() {
        try_event_driven();
        std::vector<const Variant*> open = candidates(piece_);
        for (int substeps = 1; substeps <= most_substeps; substeps *= 2) {
            std::erase_if(open, [&](const Variant* variant) { return !try_variant(*variant, substeps); });
        }
        for (int round = 0; round < further_rounds; ++round) {
            time_again();
        }
        return {.tried = std::move(tried_),
                .discs = piece_.discs.size(),
                .whole_scene = is_whole_,
                .units_of_time = units_,
                .seconds = process_seconds() - start_};
    }

  private:
    /// The first, since it says how long a trial may be, and what nobody needs to exceed.
    void try_event_driven() {
        const double before = process_seconds();
        EventDriven<double> simulation(piece_);
        Ran ran;
        ran.setting_up = process_seconds() - before;
        for (int unit = 1; unit == 1 || unit <= units_; ++unit) {
            advance_exactly(simulation, unit, ran);
            units_ = unit == 1 ? units_for(ran.units_seconds.front()) : units_;
        }
        exact_at_one_ = ran.at_one;
        amounts_ = {.exact = ran.amounts,
                    .other = {},
                    .grain = measure_ == Measure::pressure
                                 ? grain_of_impulse(simulation.wall_impulse(),
                                                    static_cast<double>(simulation.wall_collisions()))
                                 : 1};
        note({.variant = &event_driven()}, ran, {.error = own_error(ran)});
    }

    void advance_exactly(EventDriven<double>& simulation, int unit, Ran& ran) const {
        const double so_far = amount(simulation);
        const double before = process_seconds();
        require_end(simulation.advance(unit));
        ran.units_seconds.push_back(process_seconds() - before);
        ran.amounts.push_back(amount(simulation) - so_far);
        if (unit == 1) {
            ran.at_one = simulation.discs();
        }
    }

    /// What the measure is the average of, since the start.
    template <class Real> double amount(const EventDriven<Real>& simulation) const {
        return measure_ == Measure::pressure ? static_cast<double>(simulation.wall_impulse())
                                             : static_cast<double>(simulation.pair_collisions());
    }

    int units_for(double seconds) const {
        const double fewest = measure_ == Measure::path ? 1 : fewest_units_of_average;
        const double affordable = std::floor(seconds_of_one / std::max(seconds, 1e-9));
        return static_cast<int>(std::min(std::max(affordable, fewest), static_cast<double>(units_of_run_)));
    }

    /// Of the event-driven simulation: what double rounds.
    double own_error(const Ran& ran) {
        require_end(extended_.advance(measure_ == Measure::path ? 1 : units_));
        if (measure_ == Measure::path) {
            return rms_distance(ran.at_one, extended_.discs(), piece_.radius);
        }
        const double in_all = std::accumulate(ran.amounts.begin(), ran.amounts.end(), 0.0);
        return expected_average_error({.exact = {amount(extended_)}, .other = {in_all}}, 1).error;
    }

    static void require_end(bool settled) {
        if (!settled) {
            throw CheckError("the collisions of one instant do not come to an end: a disc is wedged");
        }
    }

    /// Whether more substeps of it are worth a trial.
    bool try_variant(const Variant& variant, int substeps) {
        if (process_seconds() - start_ > seconds_of_all) {
            return false;
        }
        const auto ran = run_variant(variant, substeps);
        if (!ran) {
            return false;
        }
        note({.variant = &variant, .substeps = substeps}, *ran, error_of(*ran));
        const auto cheapest = cheapest_below(tried_, bound_, units_of_run_);
        return !cheapest || cheapest->cost(units_of_run_) > tried_.back().cost(units_of_run_);
    }

    void time_again() {
        for (Tried& one : tried_) {
            if (one.largest_error() > bound_ || process_seconds() - start_ > seconds_of_all) {
                continue;
            }
            if (const auto ran = run_variant(*one.method.variant, one.method.substeps)) {
                one.setting_up = std::min(one.setting_up, times_larger_ * ran->setting_up);
                one.unit_seconds = std::min(one.unit_seconds, times_larger_ * ran->unit_seconds());
            }
        }
    }

    /// Nothing if a resolve did not end, or what it does to the walls cannot be told, or not in time.
    std::optional<Ran> run_variant(const Variant& variant, int substeps) const {
        Tuning tuning = tuning_;
        tuning.substeps = substeps;
        const double before = process_seconds();
        const auto simulation = variant.simulate(piece_, tuning);
        Ran ran;
        ran.setting_up = process_seconds() - before;
        auto watch = watch_of(variant, substeps, *simulation);
        for (int unit = 1; unit <= units_; ++unit) {
            if (!advance(*simulation, substeps, ran, watch)) {
                return std::nullopt;
            }
            if (measure_ == Measure::path && error_of(ran).error > bound_) {
                break;
            }
        }
        return ran;
    }

    /// Of the momentum that walls take up, which a step does not tell; none where nobody asks.
    std::optional<MomentumWatch> watch_of(const Variant& variant, int substeps,
                                          const Simulation& simulation) const {
        if (measure_ != Measure::pressure) {
            return std::nullopt;
        }
        return MomentumWatch(piece_, rounding_of(variant.policies), variant.policies.impact, 1.0 / substeps,
                             simulation.discs());
    }

    bool advance(Simulation& simulation, int substeps, Ran& ran, std::optional<MomentumWatch>& watch) const {
        ran.amounts.push_back(0);
        ran.units_seconds.push_back(0);
        for (int substep = 0; substep < substeps; ++substep) {
            const double before = process_seconds();
            const Tally tally = simulation.step();
            ran.units_seconds.back() += process_seconds() - before;
            if (!tally.settled) {
                return false;
            }
            if (!watch) {
                ran.amounts.back() += static_cast<double>(tally.pair_resolves);
            } else if (!look(simulation, ran, *watch)) {
                return false;
            }
        }
        if (ran.units_seconds.size() == 1) {
            ran.at_one = simulation.discs();
        }
        return true;
    }

    bool look(const Simulation& simulation, Ran& ran, MomentumWatch& watch) const {
        const double so_far = watch.balance().wall_impulse();
        watch.step(simulation.discs());
        ran.amounts.back() += watch.balance().wall_impulse() - so_far;
        return !watch.balance().from_wall_to_wall() && process_seconds() - start_ <= seconds_of_all;
    }

    Expected error_of(const Ran& ran) const {
        if (measure_ != Measure::path) {
            Amounts amounts = amounts_;
            amounts.other = ran.amounts;
            return expected_average_error(amounts, units_of_run_, times_more_);
        }
        const double error = rms_distance(ran.at_one, exact_at_one_, piece_.radius);
        return {.error = error, .margin = is_whole_ ? 0 : margin_of_piece * error};
    }

    void note(const Method& method, const Ran& ran, const Expected& expected) {
        tried_.push_back({.method = method,
                          .error = expected.error,
                          .margin = expected.margin,
                          .setting_up = times_larger_ * ran.setting_up,
                          .unit_seconds = times_larger_ * ran.unit_seconds()});
    }

    double start_ = process_seconds();
    Scene piece_;
    Tuning tuning_;
    Measure measure_;
    double bound_;
    int units_of_run_;
    bool is_whole_;
    double times_larger_; ///< the scene than the piece, in discs
    double times_more_;   ///< of what is averaged there is in the scene
    EventDriven<long double> extended_;
    int units_ = 0;
    std::vector<Disc> exact_at_one_;
    Amounts amounts_;
    std::vector<Tried> tried_;
};

} // namespace

std::vector<Method> methods_for(const Scene& scene) {
    std::vector<Method> methods{{.variant = &event_driven()}};
    for (const Variant* variant : candidates(scene)) {
        for (int substeps = 1; substeps <= most_substeps; substeps *= 2) {
            methods.push_back({.variant = variant, .substeps = substeps});
        }
    }
    return methods;
}

Trial try_methods(const Scene& scene, const Tuning& tuning, Measure measure, double bound) {
    return Trying(scene, tuning, measure, bound).run();
}

} // namespace carom
