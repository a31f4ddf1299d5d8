#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "harness/measure/measurement.hpp"
#include "harness/measure/turns.hpp"
#include "harness/measure/warm_up.hpp"
#include "harness/support/process_clock.hpp"
#include "variants/registry.hpp"

namespace carom {

/// A variant on a scene with its tunings, as one of those that take turns. All its runs, the untimed ones
/// among them, are of one simulation. The last step of the first one is checked, unless it ends in bits that
/// were found right; the others must end in the same bits after the same work.
class VariantContender final : public Contender {
  public:
    /// `right_ends` is shared by those that take turns (see Check).
    VariantContender(Measurement measurement, std::set<std::string>& right_ends)
        : measurement_(std::move(measurement)), right_ends_(right_ends) {}

    /// Runs what a process runs untimed. Returns the seconds that the whole run may be expected to take.
    double prepare() {
        const double start = process_seconds();
        simulation_ = measurement_.variant.simulate(measurement_.scene, measurement_.tuning);
        const double seconds = warm_up(measurement_, *simulation_) * steps();
        measurement_.own_seconds = measurement_.parse_seconds + process_seconds() - start;
        return seconds;
    }

    int steps() const override { return measurement_.scene.steps; }
    void start() override {
        const double start = process_seconds();
        end_run();
        if (!measurement_.violation) {
            simulation_->restart(measurement_.scene);
            const CheckScope scope = ++runs_ == 1 ? CheckScope::last_step : CheckScope::nothing;
            Check check(scope, measurement_.variant);
            check.right_ends = &right_ends_;
            run_.emplace(measurement_.scene, *simulation_, measurement_.tuning, check);
        }
        *measurement_.own_seconds += process_seconds() - start;
    }

    TurnTime advance(int steps) override { return run_ ? run_->advance(steps) : TurnTime{}; }

    /// Ends the last of so many runs. A violation is told with the run that has it, if there were several.
    void finish(int runs) {
        end_run();
        simulation_.reset();
        if (measurement_.violation && runs > 1) {
            measurement_.violation = "run " + std::to_string(runs_) + " of " + std::to_string(runs) + ": " +
                                     *measurement_.violation;
        }
    }

    const Measurement& measurement() const { return measurement_; }

  private:
    void end_run() {
        if (run_) {
            measurement_.add(run_->finish());
            *measurement_.own_seconds += measurement_.repetitions.back().steps_seconds;
            run_.reset();
        }
    }

    Measurement measurement_;
    std::set<std::string>& right_ends_;
    std::unique_ptr<Simulation> simulation_;
    std::optional<RunInParts> run_;
    int runs_ = 0; ///< that have been started
};

} // namespace carom
