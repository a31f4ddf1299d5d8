#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/measure.hpp"
#include "harness/measure/profiler.hpp"
#include "harness/scenes/generate.hpp"
#include "variants/registry.hpp"

namespace carom {
namespace {

const Scene& measured_scene() {
    static const Scene scene = generate({.count = 10'000,
                                         .side = 3162,
                                         .radius = 16,
                                         .steps = 20,
                                         .least_velocity = 2,
                                         .largest_velocity = 5,
                                         .seed = 1});
    return scene;
}

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The step loop with nothing around it.
double bare_seconds() {
    const auto simulation = find_variant("published")->simulate(measured_scene(), {});
    return seconds_of([&simulation] {
        for (int step = 0; step < measured_scene().steps; ++step) {
            simulation->step();
        }
    });
}

/// What `carom bench` reports for the same steps.
double timed_seconds() {
    const auto simulation = find_variant("published")->simulate(measured_scene(), {});
    return run_scene(measured_scene(), *simulation, {}, CheckScope::last_step).steps_seconds;
}

/// What `carom profile` reports for the same steps.
double profiled_seconds() {
    Profiler profiler({}, {}, {});
    const auto simulation = find_variant("published")->simulate_observed(measured_scene(), {}, profiler);
    return run_scene(measured_scene(), *simulation, {}, CheckScope::last_step).steps_seconds;
}

struct Interval {
    double low;
    double median;
    double high;
};

/// The median with its 95 % interval from order statistics: ranks of the binomial distribution with p = 1/2.
Interval median_interval(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto count = static_cast<double>(values.size());
    const auto low =
        static_cast<std::size_t>(std::max(0.0, std::floor(count / 2 - 0.98 * std::sqrt(count) - 0.5)));
    return {values[low], values[values.size() / 2], values[values.size() - 1 - low]};
}

/// Ratios within blocks of the three, in rotating order, so that drift hits all alike.
TEST(MeasuringCost, TimedModeAddsLessThanOnePercent) {
    const std::array<std::function<double()>, 3> ways{bare_seconds, timed_seconds, profiled_seconds};
    std::vector<double> timed;
    std::vector<double> profiled;
    bare_seconds();
    for (std::size_t block = 0; block < 45; ++block) {
        std::array<double, 3> seconds{};
        for (std::size_t k = 0; k < ways.size(); ++k) {
            const std::size_t way = (block + k) % ways.size();
            seconds[way] = ways[way]();
        }
        timed.push_back(seconds[1] / seconds[0]);
        profiled.push_back(seconds[2] / seconds[0]);
    }
    const Interval of_timed = median_interval(timed);
    const Interval of_profiled = median_interval(profiled);
    std::printf("timed over bare: %.4f [%.4f, %.4f]\n", of_timed.median, of_timed.low, of_timed.high);
    std::printf("profiled over bare: %.4f [%.4f, %.4f]\n", of_profiled.median, of_profiled.low,
                of_profiled.high);
    EXPECT_LT(of_timed.low, 1.01) << "timed mode costs more than 1 %, as far as this machine can tell";
}

} // namespace
} // namespace carom
