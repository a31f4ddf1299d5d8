#include "harness/accuracy/event_driven_errors.hpp"

#include <cmath>

#include "harness/accuracy/companion.hpp"
#include "harness/accuracy/penetration.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/verify/checker.hpp"
#include "harness/verify/overlapping_pairs.hpp"
#include "kernels/exact/event_driven.hpp"

namespace carom {
namespace {

/// |P_end - P_start - what the walls changed| over the sum of all speeds.
std::optional<double> unexplained_momentum(const Scene& scene, const EventDriven<double>& simulation) {
    double x = -simulation.momentum_from_walls()[0];
    double y = -simulation.momentum_from_walls()[1];
    double speeds = 0;
    const auto end = simulation.discs();
    for (std::size_t i = 0; i < end.size(); ++i) {
        x += end[i].vx - scene.discs[i].vx;
        y += end[i].vy - scene.discs[i].vy;
        speeds += std::hypot(scene.discs[i].vx, scene.discs[i].vy);
    }
    return speeds > 0 ? std::optional(std::hypot(x, y) / speeds) : std::nullopt;
}

/// The averages over the whole run.
void finish(const Scene& scene, const EventDriven<double>& simulation, ErrorMeasures& measures) {
    measures.discs = simulation.discs();
    measures.energy_drift = energy_drift(scene, measures.discs);
    measures.momentum_drift = unexplained_momentum(scene, simulation);
    measures.discs_outside = discs_outside(scene, measures.discs);
    if (scene.steps == 0) {
        measures.pressure_reason = "the scene has no steps";
        return;
    }
    measures.pressure = simulation.wall_impulse() / (scene.steps * 4.0 * scene.side);
    if (!scene.discs.empty()) {
        measures.collision_rate =
            static_cast<double>(simulation.pair_collisions()) /
            (static_cast<double>(scene.steps) * static_cast<double>(scene.discs.size()));
    }
}

} // namespace

ErrorMeasures measure_event_driven_errors(const Scene& scene, std::int64_t most_events) {
    EventDriven<double> simulation(scene);
    Companion<long double> companion(scene, most_events);
    const Checker checker(scene.side, scene.radius, 1, Tolerance::relative);
    Penetration penetration(overlapping_pairs(scene.discs, scene.radius), scene.radius);
    ErrorMeasures measures;
    for (int time = 1; time <= scene.steps; ++time) {
        if (!simulation.advance(time)) {
            throw CheckError(format("step %d: the collisions of one instant do not come to an end", time));
        }
        const auto discs = simulation.discs();
        penetration.add(discs, overlapping_pairs(discs, scene.radius));
        measures.unresolved_pairs += checker.count_colliding(discs);
        companion.compare(time, discs);
    }
    measures.penetration_worst = penetration.worst();
    measures.penetration_mean = penetration.mean();
    finish(scene, simulation, measures);
    companion.finish(measures);
    return measures;
}

} // namespace carom
