#pragma once

#include <cstdint>

#include "harness/accuracy/error_measures.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// How wrong the event-driven simulation itself is. Beside itself it would be without error, so its companion
/// computes in long double: what parts the two is the rounding of double. (Where long double is double, all
/// that is compared with it is 0.) Penetration is that at the ends of units of time. Throws CheckError if the
/// collisions of an instant do not come to an end.
ErrorMeasures measure_event_driven_errors(const Scene& scene, std::int64_t most_events);

} // namespace carom
