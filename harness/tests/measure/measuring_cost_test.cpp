#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/measure.hpp"
#include "kernels/tests/scenes.hpp"
#include "variants/registry.hpp"

namespace carom {
namespace {

const Scene& measured_scene() {
    static const Scene scene = tests::random_scene(10'000, 3162, 16, 20, 5, 1);
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

/// Ratios of neighbours, whose order alternates, so that drift hits both alike.
TEST(MeasuringCost, TimedModeAddsLessThanOnePercent) {
    std::vector<double> ratios;
    bare_seconds();
    for (int block = 0; block < 45; ++block) {
        const double first = block % 2 == 0 ? bare_seconds() : timed_seconds();
        const double second = block % 2 == 0 ? timed_seconds() : bare_seconds();
        ratios.push_back(block % 2 == 0 ? second / first : first / second);
    }
    const Interval timed = median_interval(ratios);
    std::printf("timed over bare: %.4f [%.4f, %.4f]\n", timed.median, timed.low, timed.high);
    EXPECT_LT(timed.low, 1.01) << "timed mode costs more than 1 %, as far as this machine can tell";
}

} // namespace
} // namespace carom
