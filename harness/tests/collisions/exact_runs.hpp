#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/collisions/path_checker.hpp"
#include "kernels/scene.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom::tests {

/// An event-driven run of a scene, followed by its checker.
struct ExactRun {
    static constexpr const char* given_up = "given up";

    PathChecker checker;
    EventDriven<double, CollisionLog<double>&> simulation;

    explicit ExactRun(const Scene& scene) : checker(scene), simulation(scene, checker) {}

    /// What is wrong with the run up to the end of the scene, looked at so many times; `given_up` if nothing
    /// is, but it takes more events than that.
    std::string wrong(const Scene& scene, int looks, const EventLimits& limits = {}) {
        for (int look = 1; look <= looks; ++look) {
            const double time = 1.0 * scene.steps * look / looks;
            if (!simulation.advance(time, limits)) {
                return checker.violation_at(simulation.time(), simulation.discs()).value_or(given_up);
            }
            if (const auto violation = checker.violation_at(time, simulation.discs())) {
                return *violation;
            }
        }
        return "";
    }
};

} // namespace carom::tests
