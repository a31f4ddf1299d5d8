#pragma once

#include <cstdint>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/counters/counters.hpp"
#include "harness/measure/profiler.hpp"

namespace carom {

/// What one `carom profile` found.
struct Profile {
    const Profiler& profiler;
    double wall_seconds; ///< of the profiled steps
    double cost;         ///< profiled over bare wall time
    std::int64_t sweeps;
    std::vector<CounterValue> counters;
};

/// As the record schema's `profile`.
nlohmann::ordered_json profile_json(const Profile& profile);

} // namespace carom
