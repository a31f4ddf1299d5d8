#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "harness/accuracy/error_measures.hpp"
#include "harness/support/format.hpp"
#include "kernels/exact/exact_simulation.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// Root of the mean squared distance of the discs to where they are exactly, in units of their radius.
template <class Real>
double rms_distance(const std::vector<Disc>& discs, const std::vector<BasicDisc<Real>>& exact,
                    double radius) {
    double sum = 0;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const auto dx = static_cast<double>(discs[i].x - exact[i].x) / radius;
        const auto dy = static_cast<double>(discs[i].y - exact[i].y) / radius;
        sum += dx * dx + dy * dy;
    }
    return discs.empty() ? 0 : std::sqrt(sum / static_cast<double>(discs.size()));
}

/// The event-driven simulation that goes along with a run, as far as its limit lets it, and what it says of
/// the run. `Real` is the precision of the reference.
template <class Real> class Companion {
  public:
    Companion(const Scene& scene, int threads, std::int64_t most_collisions)
        : scene_(scene), limits_{.in_all = most_collisions}, reference_(scene, threads) {}

    /// Compares at the end of unit of time `time`.
    void compare(int time, const std::vector<Disc>& discs) {
        if (!reason_.empty() || !advance(time)) {
            return;
        }
        const double distance = rms_distance(discs, reference_.discs(), scene_.radius);
        if (!result_.time_to_tenth_radius && distance > 0.1) {
            result_.time_to_tenth_radius = time;
        }
        if (std::has_single_bit(static_cast<unsigned>(time)) || time == scene_.steps) {
            result_.trajectory.push_back({.time = time, .rms_distance = distance});
        }
    }

    /// Fills in what the reference has to say at the end.
    void finish(ErrorMeasures& measures) {
        if (!reason_.empty()) {
            measures.reference_reason = reason_;
            return;
        }
        const auto time = static_cast<double>(scene_.steps);
        const auto count = static_cast<double>(scene_.discs.size());
        result_.collision_rate = static_cast<double>(reference_.pair_collisions()) / (time * count);
        result_.pressure = static_cast<double>(reference_.wall_impulse()) / (time * 4 * scene_.side);
        result_.speed_distance =
            kolmogorov_smirnov_distance(speeds(measures.discs), speeds(reference_.discs()));
        measures.reference = std::move(result_);
    }

  private:
    bool advance(int time) {
        if (reference_.advance(static_cast<Real>(time), limits_)) {
            return true;
        }
        reason_ = reference_.pair_collisions() + reference_.wall_collisions() > limits_.in_all
                      ? format("the reference is given up before time %d of %d, after %lld collisions", time,
                               scene_.steps, static_cast<long long>(limits_.in_all))
                      : format("the collisions of the reference at time %.6g do not come to an end: a disc "
                               "is wedged",
                               static_cast<double>(reference_.time()));
        return false;
    }

    template <class SomeDisc> static std::vector<double> speeds(const std::vector<SomeDisc>& discs) {
        std::vector<double> result;
        result.reserve(discs.size());
        for (const SomeDisc& disc : discs) {
            result.push_back(static_cast<double>(std::hypot(disc.vx, disc.vy)));
        }
        return result;
    }

    const Scene& scene_;
    EventLimits limits_;
    ExactSimulation<Real> reference_;
    AgainstReference result_;
    std::string reason_;
};

} // namespace carom
