#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "harness/accuracy/choice.hpp"
#include "harness/accuracy/costs.hpp"
#include "harness/accuracy/momentum_balance.hpp"
#include "harness/verify/rounding.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// What a trial is of: fixed before a method runs.
struct TrialCase {
    const Scene& scene;
    const Tuning& tuning;
    Measure measure;
    double bound;
    Scene piece;                 ///< what runs: the scene itself, or a piece of it
    double whole_over_piece = 1; ///< of squared errors (harness/scenes/piece.hpp)

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

    /// Seconds of that work on the piece.
    double seconds(const Method& method, const Work& work) const {
        return seconds_of(*method.variant, static_cast<double>(piece.discs.size()), work);
    }
    /// Seconds of as much for each disc of the scene.
    double seconds_of_scene(const Method& method, const Work& work) const {
        return seconds_of(*method.variant, static_cast<double>(scene.discs.size()), times_larger() * work);
    }
    Work placed() const { return {.placed = static_cast<double>(piece.discs.size())}; }
};

/// What a method did in a trial.
struct Ran {
    std::vector<Disc> at_one;    ///< the state after one unit of time
    std::vector<double> amounts; ///< of what the measure is the average of, in each unit of time
    Work work;                   ///< of all units of time, which are as many as amounts
    double seconds = 0;          ///< that it costs, setting up and watching included
};

/// Runs a method, and counts what that costs.
class MethodRun {
  public:
    /// It may cost `most` seconds.
    MethodRun(const TrialCase& given, const Method& method, double most)
        : given_(given), method_(method), most_(most),
          simulation_(method.variant->simulate(given.piece, tuned(given, method))),
          watch_(watch_of(given, method, *simulation_)), now_(given.piece) {
        ran_.seconds = given.seconds(method, given.placed());
    }

    const Ran& ran() const { return ran_; }

    /// A unit of time. False if a resolve did not end, or what it does to the walls cannot be told, or it
    /// would cost too much.
    bool advance() {
        double& amount = ran_.amounts.emplace_back(0);
        now_.discs = simulation_->discs();
        const Work step = work_of_step(*method_.variant, now_);
        for (int substep = 0; substep < method_.substeps; ++substep) {
            const Tally tally = simulation_->step();
            Work work = step;
            work.collisions = static_cast<double>(tally.pair_resolves + tally.wall_resolves);
            ran_.work += work;
            ran_.seconds += given_.seconds(method_, work) * (watch_ ? 1 + steps_of_watch : 1);
            if (!tally.settled) {
                return false;
            }
            amount += watch_ ? watch_->step(simulation_->discs()) : static_cast<double>(tally.pair_resolves);
            if (watch_ && (watch_->balance().from_wall_to_wall() || ran_.seconds > most_)) {
                return false;
            }
        }
        if (ran_.amounts.size() == 1) {
            ran_.at_one = simulation_->discs();
        }
        return true;
    }

  private:
    /// To tell what a step does to the walls takes some three times as long as the step.
    static constexpr double steps_of_watch = 3;

    static Tuning tuned(const TrialCase& given, const Method& method) {
        Tuning tuning = given.tuning;
        tuning.substeps = method.substeps;
        return tuning;
    }

    /// Of the momentum that walls take up, which a step does not tell; none where nobody asks.
    static std::optional<MomentumWatch> watch_of(const TrialCase& given, const Method& method,
                                                 const Simulation& simulation) {
        if (given.measure != Measure::pressure) {
            return std::nullopt;
        }
        const Policies& policies = method.variant->policies;
        return MomentumWatch(given.piece, rounding_of(policies), policies.impact, 1.0 / method.substeps,
                             simulation.discs());
    }

    const TrialCase& given_;
    const Method& method_;
    double most_;
    std::unique_ptr<Simulation> simulation_;
    std::optional<MomentumWatch> watch_;
    Scene now_; ///< the piece as it has become
    Ran ran_;
};

} // namespace carom
