#include "harness/measure/variant_contender.hpp"

#include <utility>

#include "harness/measure/warm_up.hpp"
#include "harness/support/process_clock.hpp"

namespace carom {

double VariantContender::prepare() {
    const double start = process_seconds();
    const double seconds = warm_up(measurement_) * steps();
    if (!measurement_.violation) {
        simulation_ = measurement_.variant.simulate(measurement_.scene, measurement_.tuning);
        run_.emplace(measurement_.scene, *simulation_, measurement_.tuning,
                     Check(CheckScope::last_step, measurement_.variant.policies));
    }
    measurement_.own_seconds = measurement_.parse_seconds + process_seconds() - start;
    return seconds;
}

double VariantContender::advance(int steps) { return run_ ? run_->advance(steps) : 0; }

void VariantContender::finish(Turns turns) {
    if (!run_) {
        return;
    }
    measurement_.repetitions.push_back(run_->finish());
    measurement_.violation = measurement_.repetitions.back().violation;
    *measurement_.own_seconds += measurement_.repetitions.back().steps_seconds;
    measurement_.turns = std::move(turns);
    run_.reset();
    simulation_.reset();
}

} // namespace carom
