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

TEST(Costs, LieBetweenTheSizesMeasured) {
    EXPECT_DOUBLE_EQ(Costs(event_driven(), 2'000).collisions(10), 3e-6);
    EXPECT_DOUBLE_EQ(Costs(event_driven(), 1).collisions(10), 3e-6) << "smaller than the smallest measured";
    EXPECT_DOUBLE_EQ(Costs(event_driven(), 40'000).collisions(10), 3.8e-6);
    EXPECT_DOUBLE_EQ(Costs(event_driven(), 1'000'000'000).collisions(10), 6e-6);
    EXPECT_NEAR(Costs(plain, 126'491).collisions(10), 3e-7, 1e-12) << "in the middle of a logarithmic axis";
}

TEST(Costs, AreOfTheWorkOfAScene) {
    const Scene scene{
        .side = 100, .radius = 1, .steps = 1, .discs = {{10, 10, 1, -2}, {11, 10, 3, 0}, {90, 90, 0, 0}}};
    EXPECT_DOUBLE_EQ(Costs(plain, 40'000).step(scene), 1e-9 * 3.5 * 4.5 * (2 * 2 + 1)) << "discs in one box";
    EXPECT_DOUBLE_EQ(Costs(event_driven(), 2'000).step(scene), 1e-9 * 120 * 6 / 50)
        << "cells of half the side";
    EXPECT_DOUBLE_EQ(Costs(event_driven(), 2'000).setting_up(scene), 1e-9 * 100 * 3);
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
