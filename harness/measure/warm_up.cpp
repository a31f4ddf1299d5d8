#include "harness/measure/warm_up.hpp"

#include <algorithm>
#include <utility>

namespace carom {
namespace {

constexpr int fewest_steps = 2;

} // namespace

double warm_up(Measurement& measurement, Simulation& simulation) {
    if (measurement.scope == CheckScope::every_step) {
        Run run = checked_run(measurement.scene, measurement.variant, measurement.tuning);
        if (run.violation) {
            measurement.add(std::move(run));
            return 0;
        }
    }
    const Scene& scene = measurement.scene;
    const int steps = measurement.warm_ups > 0 ? scene.steps : std::min(scene.steps, fewest_steps);
    double seconds = 0;
    for (int k = 0; k < std::max(measurement.warm_ups, 1); ++k) {
        simulation.restart(scene);
        RunInParts run(scene, simulation, measurement.tuning, CheckScope::nothing);
        seconds = run.advance(steps).seconds;
    }
    return seconds / steps;
}

} // namespace carom
