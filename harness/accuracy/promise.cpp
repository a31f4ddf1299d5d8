#include "harness/accuracy/promise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "harness/support/process_clock.hpp"

namespace carom {
namespace {

/// Of all that may be the cheapest, in turns: whatever else runs can only lengthen a run.
constexpr int rounds = 5;

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Of what could cost less than the chosen method, by one run of each: runs are short, and noisy.
constexpr double slack = 1.2;

/// A run's tuning with a method's own substeps.
Tuning tuned(Tuning tuning, const Method& method) {
    tuning.substeps = method.substeps;
    return tuning;
}

} // namespace

double error_of(const ErrorMeasures& errors, Measure measure) {
    if (!errors.reference) {
        return nothing;
    }
    const AgainstReference& reference = *errors.reference;
    switch (measure) {
    case Measure::path:
        return reference.trajectory.empty() ? nothing : reference.trajectory.front().rms_distance;
    case Measure::collision_rate:
        return errors.collision_rate.value_or(0) == reference.collision_rate
                   ? 0
                   : std::abs(errors.collision_rate.value_or(nothing) / reference.collision_rate - 1);
    case Measure::pressure:
        return errors.pressure.value_or(nothing) == reference.pressure
                   ? 0
                   : std::abs(errors.pressure.value_or(nothing) / reference.pressure - 1);
    }
    return nothing;
}

Promises::Promises(const Scene& scene, const Tuning& tuning, const Costs& costs)
    : scene_(scene), tuning_(tuning), costs_(costs), methods_(methods_for(scene)) {}

/// Seconds of a whole run, setting up included; infinite if it takes more than `most`, or does not end.
double Promises::time_run(const Method& method, double most) const {
    const double start = process_seconds();
    const auto simulation = method.variant->simulate(scene_, tuned(tuning_, method));
    const int steps = scene_.steps * method.substeps;
    for (int step = 0; step < steps; ++step) {
        if (!simulation->step().settled || process_seconds() - start > most) {
            return unlimited;
        }
    }
    return process_seconds() - start;
}

double Promises::error_of_run(const Method& method, Measure measure) {
    auto known = std::ranges::find(measured_, method, &Measured::method);
    if (known == measured_.end()) {
        measured_.push_back(
            {.method = method, .errors = measure_errors(scene_, *method.variant, tuned(tuning_, method))});
        known = measured_.end() - 1;
    }
    return error_of(known->errors, measure);
}

/// The other methods whose whole run takes hardly longer than the chosen one's, and keeps the bound; yet to
/// be timed.
std::vector<Delivered> Promises::rivals_of(const Promise& promise) {
    const Delivered& chosen = promise.delivered;
    std::vector<Delivered> rivals;
    for (const Method& method : methods_) {
        if (method == chosen.method || time_run(method, slack * chosen.seconds) == unlimited) {
            continue;
        }
        const double error = error_of_run(method, promise.measure);
        if (error <= promise.bound) {
            rivals.push_back({.method = method, .seconds = unlimited, .error = error});
        }
    }
    return rivals;
}

std::optional<Promise> Promises::keep(Measure measure, double bound) {
    const Trial trial = try_methods(scene_, tuning_, measure, bound, costs_);
    const auto chosen = cheapest_below(trial.tried, bound, scene_.steps);
    if (!chosen) {
        return std::nullopt;
    }
    Promise promise{.bound = bound,
                    .measure = measure,
                    .promised = *chosen,
                    .trial_seconds = trial.seconds,
                    .delivered = {.method = chosen->method,
                                  .seconds = time_run(chosen->method, unlimited),
                                  .error = error_of_run(chosen->method, measure)},
                    .cheapest = {},
                    .methods = static_cast<int>(methods_.size())};
    auto contenders = rivals_of(promise);
    contenders.push_back(promise.delivered);
    for (int round = 0; round < rounds; ++round) {
        for (Delivered& one : contenders) {
            one.seconds = std::min(one.seconds, time_run(one.method, unlimited));
        }
    }
    promise.delivered = contenders.back();
    if (!promise.is_kept() && contenders.size() > 1) {
        contenders.pop_back();
    }
    promise.cheapest = *std::ranges::min_element(contenders, {}, &Delivered::seconds);
    return promise;
}

} // namespace carom
