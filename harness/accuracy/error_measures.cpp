#include "harness/accuracy/error_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "harness/accuracy/companion.hpp"
#include "harness/accuracy/momentum_balance.hpp"
#include "harness/accuracy/penetration.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/measure/measure.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/support/json.hpp"
#include "harness/verify/checker.hpp"
#include "harness/verify/overlapping_pairs.hpp"
#include "kernels/exact/event_driven.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

/// What a run did in all, for unit mass.
struct Totals {
    double unexplained = 0;  ///< magnitude of the change of momentum that no wall explains
    double wall_impulse = 0; ///< momentum that all four walls took up
    std::int64_t pair_resolves = 0;
};

void finish(const Scene& scene, const Totals& totals, const Penetration& penetration, std::vector<Disc> end,
            ErrorMeasures& measures) {
    double speed_sum = 0;
    for (const Disc& disc : scene.discs) {
        speed_sum += std::hypot(disc.vx, disc.vy);
    }
    if (speed_sum > 0) {
        measures.momentum_drift = totals.unexplained / speed_sum;
    }
    measures.penetration_worst = penetration.worst();
    measures.penetration_mean = penetration.mean();
    measures.energy_drift = energy_drift(scene, end);
    measures.discs_outside = discs_outside(scene, end);
    measures.discs = std::move(end);
    if (scene.steps == 0) {
        measures.pressure_reason = "the scene has no steps";
        return;
    }
    measures.pressure = totals.wall_impulse / (scene.steps * 4.0 * scene.side);
    if (!scene.discs.empty()) {
        measures.collision_rate =
            static_cast<double>(totals.pair_resolves) /
            (static_cast<double>(scene.steps) * static_cast<double>(scene.discs.size()));
    }
}

/// |P_end - P_start - what the walls changed|.
double unexplained_momentum(const Scene& scene, const ExactSimulation<double>& simulation) {
    double x = -simulation.momentum_from_walls()[0];
    double y = -simulation.momentum_from_walls()[1];
    const auto end = simulation.discs();
    for (std::size_t i = 0; i < end.size(); ++i) {
        x += end[i].vx - scene.discs[i].vx;
        y += end[i].vy - scene.discs[i].vy;
    }
    return std::hypot(x, y);
}

/// How wrong the event-driven simulation itself is. Beside itself it would be without error, so its companion
/// computes in long double: what parts the two is the rounding of double. (Where long double is double, all
/// that is compared with it is 0.) Penetration is that at the ends of units of time.
ErrorMeasures measure_event_driven_errors(const Scene& scene, int threads, std::int64_t most_collisions) {
    ExactSimulation<double> simulation(scene, threads);
    Companion<long double> companion(scene, threads, most_collisions);
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
    finish(scene,
           {.unexplained = unexplained_momentum(scene, simulation),
            .wall_impulse = simulation.wall_impulse(),
            .pair_resolves = simulation.pair_collisions()},
           penetration, simulation.discs(), measures);
    companion.finish(measures);
    return measures;
}

std::int64_t resolves_of_step(Simulation& simulation, int time, const Tuning& tuning) {
    const Tally tally = simulation.step();
    if (!tally.settled) {
        throw CheckError(
            format("step %d: the resolve did not end within %d sweeps", time, tuning.sweep_limit));
    }
    return tally.pair_resolves;
}

} // namespace

double kolmogorov_smirnov_distance(std::vector<double> one, std::vector<double> two) {
    if (one.empty() || two.empty()) {
        return 0;
    }
    std::ranges::sort(one);
    std::ranges::sort(two);
    const double slack = 1e-6 * std::max(one.back(), two.back());
    double largest = 0;
    std::size_t below_one = 0;
    std::size_t below_two = 0;
    while (below_one < one.size() && below_two < two.size()) {
        const double value = std::min(one[below_one], two[below_two]) + slack;
        while (below_one < one.size() && one[below_one] <= value) {
            ++below_one;
        }
        while (below_two < two.size() && two[below_two] <= value) {
            ++below_two;
        }
        largest =
            std::max(largest, std::abs(static_cast<double>(below_one) / static_cast<double>(one.size()) -
                                       static_cast<double>(below_two) / static_cast<double>(two.size())));
    }
    return largest;
}

ErrorMeasures measure_errors(const Scene& scene, const Variant& variant, const Tuning& tuning,
                             std::int64_t most_collisions) {
    if (variant.engine == Engine::event_driven) {
        return measure_event_driven_errors(scene, tuning.threads, most_collisions);
    }
    const auto simulation = variant.simulate(scene, tuning);
    const Rounding rounding = rounding_of(variant.policies);
    const double radius = rounding(scene.radius);
    const double dt = 1.0 / tuning.substeps;
    const Checker checker(scene.side, scene.radius, dt, tuning.tolerance, rounding, variant.policies.impact);
    Companion<double> companion(scene, tuning.threads, most_collisions);
    std::vector<Disc> discs = simulation->discs();
    MomentumWatch momentum(scene, rounding, variant.policies.impact, dt, discs);
    Penetration penetration(overlapping_pairs(discs, radius, rounding), radius);
    std::int64_t pair_resolves = 0;
    ErrorMeasures measures;
    for (int time = 1; time <= scene.steps; ++time) {
        for (int substep = 1; substep <= tuning.substeps; ++substep) {
            pair_resolves += resolves_of_step(*simulation, time, tuning);
            discs = simulation->discs();
            const auto pairs = overlapping_pairs(discs, radius, rounding);
            momentum.step(discs, pairs);
            penetration.add(discs, pairs);
        }
        measures.unresolved_pairs += checker.count_colliding(discs);
        companion.compare(time, discs);
    }
    const MomentumBalance& balance = momentum.balance();
    finish(scene,
           {.unexplained = balance.unexplained(),
            .wall_impulse = balance.wall_impulse(),
            .pair_resolves = pair_resolves},
           penetration, std::move(discs), measures);
    if (balance.from_wall_to_wall()) {
        measures.pressure.reset();
        measures.pressure_reason = "a group of overlapping discs reached from wall to wall";
    }
    companion.finish(measures);
    return measures;
}

Json error_measures_json(const ErrorMeasures& measures) {
    const bool compared = measures.reference.has_value();
    const AgainstReference reference = measures.reference.value_or(AgainstReference());
    const auto if_compared = [&](double value) { return compared ? number_or_null(value) : Json(nullptr); };
    Json trajectory = compared ? Json::array() : Json(nullptr);
    for (const DistanceAt& at : reference.trajectory) {
        trajectory.push_back({{"time", at.time}, {"rms_distance", number_or_null(at.rms_distance)}});
    }
    return {{"energy_drift", number_or_null(measures.energy_drift)},
            {"discs_outside", measures.discs_outside},
            {"unresolved_pairs", measures.unresolved_pairs},
            {"momentum_drift", number_or_null(measures.momentum_drift)},
            {"penetration_worst", measures.penetration_worst},
            {"penetration_mean", measures.penetration_mean},
            {"collision_rate", number_or_null(measures.collision_rate)},
            {"pressure", number_or_null(measures.pressure)},
            {"pressure_reason", text_or_null(measures.pressure_reason)},
            {"trajectory", trajectory},
            {"time_to_tenth_radius", or_null(reference.time_to_tenth_radius)},
            {"collision_rate_reference", if_compared(reference.collision_rate)},
            {"pressure_reference", if_compared(reference.pressure)},
            {"speed_distance", if_compared(reference.speed_distance)},
            {"reference_reason", text_or_null(measures.reference_reason)}};
}

} // namespace carom
