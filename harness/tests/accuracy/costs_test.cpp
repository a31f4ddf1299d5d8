#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "harness/accuracy/choice.hpp"
#include "harness/accuracy/costs.hpp"
#include "harness/accuracy/trial.hpp"
#include "harness/scenes/generate.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

const Variant& plain = *find_variant("published");

TEST(Costs, OfWorkAreSummedAndLieBetweenTheSizesMeasured) {
    const Work work{.placed = 1000, .moved = 100, .near = 10, .collisions = 1};
    EXPECT_DOUBLE_EQ(seconds_of(event_driven(), 2'000, work), 112.3e-6);
    EXPECT_DOUBLE_EQ(seconds_of(event_driven(), 1, work), 112.3e-6) << "smaller than the smallest measured";
    EXPECT_DOUBLE_EQ(seconds_of(event_driven(), 1e9, work), 425.1e-6);
    const double middle = std::sqrt(40'000.0 * 400'000.0);
    EXPECT_NEAR(seconds_of(plain, middle, work), (3.055e-6 + 14.08e-6) / 2, 1e-15) << "on a logarithmic axis";
}

TEST(Costs, CountTheWorkOfAScene) {
    const Scene scene{
        .side = 100, .radius = 1, .steps = 1, .discs = {{10, 10, 1, -2}, {11, 10, 3, 0}, {90, 90, 0, 0}}};
    EXPECT_EQ(work_of_step(plain, scene).moved, 3);
    EXPECT_EQ(work_of_step(plain, scene).near, 4.5 * (2 * 2 + 1));
    EXPECT_DOUBLE_EQ(work_of_events(scene).moved, 6 / 50.0) << "cells of half the side";
    EXPECT_EQ(work_of_events(scene).near, 3);
}

/// Twelve times, on different numbers of threads: a choice by the clock came out differently.
TEST(TryMethods, ChoosesTheSameEveryTimeOnAnyNumberOfThreads) {
    const Scene scene = generate({.count = 3000,
                                  .side = std::sqrt(3000 * std::numbers::pi / 0.3),
                                  .radius = 1,
                                  .steps = 8,
                                  .least_velocity = 0.1,
                                  .largest_velocity = 0.6,
                                  .seed = 5,
                                  .placement = Placement::random,
                                  .isotropic = true});
    for (const Measure measure : {Measure::path, Measure::collision_rate, Measure::pressure}) {
        const Trial first = try_methods(scene, {}, measure, 0.1);
        for (int turn = 0; turn < 12; ++turn) {
            const Trial again = try_methods(scene, {.threads = 1 + turn % 4}, measure, 0.1);
            ASSERT_EQ(again.tried.size(), first.tried.size());
            for (std::size_t k = 0; k < first.tried.size(); ++k) {
                EXPECT_EQ(again.tried[k].method, first.tried[k].method);
                EXPECT_EQ(again.tried[k].error, first.tried[k].error);
                EXPECT_EQ(again.tried[k].unit_seconds, first.tried[k].unit_seconds);
            }
        }
    }
}

} // namespace
} // namespace carom
