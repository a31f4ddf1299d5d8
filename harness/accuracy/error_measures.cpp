#include "harness/accuracy/error_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "harness/accuracy/companion.hpp"
#include "harness/accuracy/event_driven_errors.hpp"
#include "harness/accuracy/momentum_watch.hpp"
#include "harness/accuracy/penetration.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/measure/measure.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/support/json.hpp"
#include "harness/verify/checker.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

/// Measures what is seen at every step of a run.
class Watch {
  public:
    Watch(const Scene& scene, const Rounding& rounding, Impact impact, double dt,
          const std::vector<Disc>& start)
        : momentum_(scene, rounding, impact, dt, start), rounding_(rounding), radius_(rounding(scene.radius)),
          penetration_(overlapping_pairs(start, radius_, rounding), radius_) {}

    void step(const std::vector<Disc>& discs, const Tally& tally) {
        const auto pairs = overlapping_pairs(discs, radius_, rounding_);
        momentum_.step(discs, pairs);
        penetration_.add(discs, pairs);
        pair_resolves_ += tally.pair_resolves;
    }

    void finish(const Scene& scene, ErrorMeasures& measures) const {
        const MomentumBalance& balance = momentum_.balance();
        double speed_sum = 0;
        for (const Disc& disc : scene.discs) {
            speed_sum += std::hypot(disc.vx, disc.vy);
        }
        if (speed_sum > 0) {
            measures.momentum_drift = balance.unexplained() / speed_sum;
        }
        measures.penetration_worst = penetration_.worst();
        measures.penetration_mean = penetration_.mean();
        if (scene.steps > 0 && !scene.discs.empty()) {
            measures.collision_rate =
                static_cast<double>(pair_resolves_) /
                (static_cast<double>(scene.steps) * static_cast<double>(scene.discs.size()));
        }
        if (balance.from_wall_to_wall()) {
            measures.pressure_reason = "a group of overlapping discs reached from wall to wall";
        } else if (scene.steps > 0) {
            measures.pressure = balance.wall_impulse() / (scene.steps * 4.0 * scene.side);
        } else {
            measures.pressure_reason = "the scene has no steps";
        }
    }

  private:
    MomentumWatch momentum_;
    Rounding rounding_;
    double radius_;
    Penetration penetration_;
    std::int64_t pair_resolves_ = 0;
};

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
                             std::int64_t most_events) {
    if (variant.engine == Engine::event_driven) {
        return measure_event_driven_errors(scene, most_events);
    }
    const auto simulation = variant.simulate(scene, tuning);
    const Rounding rounding = rounding_of(variant.policies);
    const Checker checker(scene.side, scene.radius, 1.0 / tuning.substeps, tuning.tolerance, rounding,
                          variant.policies.impact);
    Companion<double> companion(scene, most_events);
    Watch watch(scene, rounding, variant.policies.impact, 1.0 / tuning.substeps, simulation->discs());
    ErrorMeasures measures;
    for (int time = 1; time <= scene.steps; ++time) {
        for (int substep = 1; substep <= tuning.substeps; ++substep) {
            const Tally tally = simulation->step();
            if (!tally.settled) {
                throw CheckError(
                    format("step %d: the resolve did not end within %d sweeps", time, tuning.sweep_limit));
            }
            watch.step(simulation->discs(), tally);
        }
        measures.unresolved_pairs += checker.count_colliding(simulation->discs());
        companion.compare(time, simulation->discs());
    }
    measures.discs = simulation->discs();
    measures.energy_drift = energy_drift(scene, measures.discs);
    measures.discs_outside = discs_outside(scene, measures.discs);
    watch.finish(scene, measures);
    companion.finish(measures);
    return measures;
}

Json error_measures_json(const ErrorMeasures& measures) {
    Json json{{"energy_drift", number_or_null(measures.energy_drift)},
              {"discs_outside", measures.discs_outside},
              {"unresolved_pairs", measures.unresolved_pairs},
              {"momentum_drift", number_or_null(measures.momentum_drift)},
              {"penetration_worst", measures.penetration_worst},
              {"penetration_mean", measures.penetration_mean},
              {"collision_rate", number_or_null(measures.collision_rate)},
              {"pressure", number_or_null(measures.pressure)},
              {"pressure_reason", text_or_null(measures.pressure_reason)},
              {"trajectory", nullptr},
              {"time_to_tenth_radius", nullptr},
              {"collision_rate_reference", nullptr},
              {"pressure_reference", nullptr},
              {"speed_distance", nullptr},
              {"reference_reason", text_or_null(measures.reference_reason)}};
    if (measures.reference) {
        const AgainstReference& reference = *measures.reference;
        json["trajectory"] = Json::array();
        for (const DistanceAt& at : reference.trajectory) {
            json["trajectory"].push_back(
                {{"time", at.time}, {"rms_distance", number_or_null(at.rms_distance)}});
        }
        if (reference.time_to_tenth_radius) {
            json["time_to_tenth_radius"] = *reference.time_to_tenth_radius;
        }
        json["collision_rate_reference"] = number_or_null(reference.collision_rate);
        json["pressure_reference"] = number_or_null(reference.pressure);
        json["speed_distance"] = number_or_null(reference.speed_distance);
    }
    return json;
}

} // namespace carom
