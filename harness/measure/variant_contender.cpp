#include "harness/measure/variant_contender.hpp"

#include <string>
#include <utility>

#include "harness/measure/warm_up.hpp"
#include "harness/support/process_clock.hpp"

namespace carom {

double VariantContender::prepare() {
    const double start = process_seconds();
    simulation_ = measurement_.variant.simulate(measurement_.scene, measurement_.tuning);
    const double seconds = warm_up(measurement_, *simulation_) * steps();
    measurement_.own_seconds = measurement_.parse_seconds + process_seconds() - start;
    return seconds;
}

void VariantContender::start() {
    const double start = process_seconds();
    end_run();
    if (!measurement_.violation) {
        simulation_->restart(measurement_.scene);
        const CheckScope scope = ++runs_ == 1 ? CheckScope::last_step : CheckScope::nothing;
        run_.emplace(measurement_.scene, *simulation_, measurement_.tuning,
                     Check(scope, measurement_.variant));
    }
    *measurement_.own_seconds += process_seconds() - start;
}

TurnTime VariantContender::advance(int steps) { return run_ ? run_->advance(steps) : TurnTime{}; }

void VariantContender::end_run() {
    if (run_) {
        measurement_.add(run_->finish());
        *measurement_.own_seconds += measurement_.repetitions.back().steps_seconds;
        run_.reset();
    }
}

void VariantContender::finish(Turns turns) {
    end_run();
    simulation_.reset();
    if (runs_ == 0) {
        return;
    }
    if (measurement_.violation && turns.plan.runs > 1) {
        measurement_.violation = "run " + std::to_string(runs_) + " of " + std::to_string(turns.plan.runs) +
                                 ": " + *measurement_.violation;
    }
    measurement_.turns = std::move(turns);
}

} // namespace carom
