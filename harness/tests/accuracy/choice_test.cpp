#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/accuracy/choice.hpp"
#include "harness/tests/scenes/gas.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

TEST(CheapestBelow, IsTheCheapestOfThoseThatSurelyReachTheBound) {
    const auto result = [](int substeps, double error, double margin, double unit_seconds) {
        return TrialResult{
            .method = {.substeps = substeps}, .error = error, .margin = margin, .unit_seconds = unit_seconds};
    };
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const std::vector<TrialResult> all{result(1, 0.1, 0, 1), result(2, 0.04, 0.01, 2), result(4, 0.02, 0, 4),
                                       result(8, 1e-14, 0, 3), result(16, unknown, 0, 0.1)};
    EXPECT_EQ(cheapest_below(all, 0.2)->method.substeps, 1);
    EXPECT_EQ(cheapest_below(all, 0.05)->method.substeps, 2) << "the bound itself is reached";
    EXPECT_EQ(cheapest_below(all, 0.045)->method.substeps, 8)
        << "the margin counts, and no order of the list";
    EXPECT_EQ(cheapest_below(all, 1e-15), std::nullopt);
    EXPECT_EQ(most_exact(all).method.substeps, 8);
}

/// Discs that are apart, none of which any number in the program was fitted to.
Scene unseen(std::uint64_t seed, int steps = 8) {
    constexpr std::array<double, 4> area_fractions{0.05, 0.2, 0.45, 0.7};
    constexpr std::array<int, 3> counts{200, 500, 1100};
    const int count = counts[seed % counts.size()];
    return tests::gas(count, tests::side_of(count, area_fractions[seed % area_fractions.size()]), steps, 0.1,
                      0.1 + 0.075 * static_cast<double>(seed % 12), 1900 + seed);
}

class KeptPromise : public testing::TestWithParam<Measure> {
  protected:
    /// What the run has of the error that it was chosen for.
    double share_of_bound(const Scene& scene, double bound) {
        const Trial trial = try_methods(scene, {}, GetParam(), bound);
        EXPECT_EQ(trial.results.front().method.variant, &event_driven());
        const Method method = cheapest_below(trial.results, bound).value().method;
        const ErrorMeasures errors = measure_errors(scene, *method.variant, {.substeps = method.substeps});
        return error_by(errors, GetParam()) / bound;
    }
};

TEST_P(KeptPromise, OnScenesNotSeenBefore) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        for (const double bound : {0.1, 0.01, 1e-9}) {
            EXPECT_LE(share_of_bound(unseen(seed), bound), 1) << seed << ", " << bound;
        }
    }
}

TEST_P(KeptPromise, OfRunsOfWhichTheBeginningAloneIsTried) {
    for (const std::uint64_t seed : {2U, 5U, 8U, 11U}) {
        EXPECT_LE(share_of_bound(unseen(seed, 120), 0.05), 1) << seed;
    }
}

/// A choice by the clock came out differently.
TEST_P(KeptPromise, IsTheSameEveryTimeOnAnyNumberOfThreads) {
    const Trial first = try_methods(unseen(2), {}, GetParam(), 0.1);
    for (int threads = 1; threads <= 4; ++threads) {
        EXPECT_EQ(try_methods(unseen(2), {.threads = threads}, GetParam(), 0.1).results, first.results);
    }
}

INSTANTIATE_TEST_SUITE_P(TryMethods, KeptPromise,
                         testing::Values(Measure::path, Measure::collision_rate, Measure::pressure),
                         [](const auto& now) {
                             return std::string(now.param == Measure::path             ? "path"
                                                : now.param == Measure::collision_rate ? "collision_rate"
                                                                                       : "pressure");
                         });

/// So many discs that no more than fifty of hundred units of time are tried.
TEST(TryMethods, CountsTheCollisionsThatAnAverageIsOf) {
    Scene scene = unseen(0, 100);
    for (int copy = 1; copy < 3200 / 200; ++copy) {
        for (std::size_t i = 0; i < 200; ++i) {
            scene.discs.push_back(scene.discs[i]);
            scene.discs.back().x += copy % 4 * scene.side;
            scene.discs.back().y += copy / 4 * scene.side;
        }
    }
    scene.side *= 4;
    const Trial moving = try_methods(scene, {}, Measure::collision_rate, 1);
    EventDriven<double> exact(scene);
    exact.advance(moving.units_of_time);
    const double collisions = static_cast<double>(exact.pair_collisions());
    EXPECT_NEAR(moving.results.at(1).margin, 2 * std::sqrt(4 / collisions), 1e-9)
        << "twice the deviation of both, and as much in what is to come";
    EXPECT_GT(try_methods(scene, {}, Measure::pressure, 1).results.at(1).margin, moving.results.at(1).margin)
        << "fewer walls are met than discs";
    for (Disc& disc : scene.discs) {
        disc.vx = disc.vy = 0;
    }
    for (const Measure measure : {Measure::collision_rate, Measure::pressure}) {
        const Trial trial = try_methods(scene, {}, measure, 1);
        EXPECT_EQ(trial.results.at(1).error, 0);
        EXPECT_EQ(trial.results.at(1).margin, std::numeric_limits<double>::infinity()) << "may happen yet";
        EXPECT_EQ(cheapest_below(trial.results, 1)->method.variant, &event_driven());
    }
}

TEST(TryMethods, TriesNoMoreSubstepsThanTheBoundTakesNorWhatCostsMoreThanTheExactRun) {
    for (const auto& [bound, most_substeps] : {std::pair{0.5, 1}, std::pair{1e-300, 64}}) {
        const Trial trial = try_methods(unseen(3), {}, Measure::path, bound);
        const double exact = trial.results.front().unit_seconds;
        for (const TrialResult& one : trial.results) {
            EXPECT_LE(one.method.substeps, most_substeps);
            EXPECT_LE(one.unit_seconds, 3 * exact) << one.method.variant->name << one.method.substeps;
        }
        EXPECT_TRUE(trial.whole_scene);
        EXPECT_EQ(trial.discs, unseen(3).discs.size());
        EXPECT_EQ(trial.units_of_time, 1);
    }
}

} // namespace
} // namespace carom
