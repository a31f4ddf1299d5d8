#pragma once

#include <cmath>

#include "harness/accuracy/choice.hpp"
#include "harness/accuracy/error_measures.hpp"

namespace carom::tests {

/// The error of a whole run by that measure, whose reference got to the run's end.
inline double error_of(const ErrorMeasures& errors, Measure measure) {
    const AgainstReference& reference = errors.reference.value();
    if (measure == Measure::path) {
        return reference.trajectory.front().rms_distance;
    }
    const bool is_pressure = measure == Measure::pressure;
    const double found = (is_pressure ? errors.pressure : errors.collision_rate).value_or(0);
    const double expected = is_pressure ? reference.pressure : reference.collision_rate;
    return found == expected ? 0 : std::abs(found / expected - 1);
}

} // namespace carom::tests
