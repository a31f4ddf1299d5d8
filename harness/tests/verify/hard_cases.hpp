#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/measure.hpp"
#include "harness/scenes/hard_cases.hpp"
#include "kernels/exact/event_driven.hpp"
#include "variants/registry.hpp"

namespace carom::tests {

inline Scene scene_of(std::string_view name) { return find_hard_case(name)->scene(); }

/// Runs all steps of a scene; the checker looks at every one of them, and has to pass it.
inline Run checked_run(const Variant& variant, const Scene& scene, const Tuning& tuning = {},
                       const OnStep& on_step = nullptr) {
    Run run = carom::checked_run(scene, variant, tuning, on_step);
    EXPECT_EQ(run.violation.value_or(""), "");
    return run;
}

/// The discs of the scene as the variant holds them at the start, in its own precision.
inline std::vector<Disc> start_of(const Variant& variant, const Scene& scene) {
    return variant.simulate(scene, {})->discs();
}

/// Largest distance of a disc to its counterpart.
inline double largest_distance(const std::vector<Disc>& one, const std::vector<Disc>& two) {
    double largest = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        largest = std::max(largest, std::hypot(one[i].x - two[i].x, one[i].y - two[i].y));
    }
    return largest;
}

} // namespace carom::tests
