#include "harness/measure/warm_up.hpp"

#include <algorithm>
#include <utility>

namespace carom {
namespace {

constexpr int fewest_steps = 2;

Run untimed(const Measurement& measurement, const Scene& scene) {
    const auto simulation = measurement.variant.simulate(scene, measurement.tuning);
    return run_scene(scene, *simulation, measurement.tuning, CheckScope::nothing);
}

} // namespace

double warm_up(Measurement& measurement) {
    if (measurement.scope == CheckScope::every_step) {
        Run run = checked_run(measurement.scene, measurement.variant, measurement.tuning);
        measurement.violation = run.violation;
        if (run.violation) {
            measurement.repetitions.push_back(std::move(run));
            return 0;
        }
    }
    Scene scene = measurement.scene;
    if (measurement.warm_ups == 0) {
        scene.steps = std::min(scene.steps, fewest_steps);
    }
    double seconds = 0;
    for (int k = 0; k < std::max(measurement.warm_ups, 1); ++k) {
        seconds = untimed(measurement, scene).steps_seconds;
    }
    return seconds / scene.steps;
}

} // namespace carom
