#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/accuracy/choice.hpp"
#include "harness/accuracy/error_measures.hpp"
#include "harness/accuracy/trial.hpp"
#include "harness/scenes/generate.hpp"
#include "harness/tests/accuracy/error_of.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

const Variant& published = *find_variant("published");

Tried tried(int substeps, double error, double unit_seconds, double margin = 0, double setting_up = 0) {
    return {.method = {.variant = &published, .substeps = substeps},
            .error = error,
            .margin = margin,
            .setting_up = setting_up,
            .unit_seconds = unit_seconds};
}

TEST(CheapestBelow, IsTheCheapestOfThoseThatReachTheBound) {
    const std::vector<Tried> all{tried(1, 0.1, 1), tried(2, 0.05, 2), tried(4, 0.02, 4), tried(8, 1e-14, 3)};
    EXPECT_EQ(cheapest_below(all, 0.2, 10)->method.substeps, 1);
    EXPECT_EQ(cheapest_below(all, 0.05, 10)->method.substeps, 2) << "the bound itself is reached";
    EXPECT_EQ(cheapest_below(all, 0.02, 10)->method.substeps, 8) << "the more exact one is cheaper";
    EXPECT_EQ(cheapest_below(all, 1e-15, 10), std::nullopt);
    EXPECT_EQ(cheapest_below({}, 1, 10), std::nullopt);
}

TEST(CheapestBelow, TakesTheMostExactOfThoseThatCostAboutAsLittle) {
    const std::vector<Tried> all{tried(1, 0.1, 1), tried(2, 0.05, 1.09), tried(4, 0.02, 1.11)};
    EXPECT_EQ(cheapest_below(all, 0.2, 10)->method.substeps, 2);
    EXPECT_EQ(cheapest_below(all, 0.03, 10)->method.substeps, 4);
}

TEST(CheapestBelow, CountsWhatTheTrialLeavesOpenAgainstAMethod) {
    const std::vector<Tried> all{tried(1, 0.009, 1, 0.002), tried(2, 0.005, 2, 0.002)};
    EXPECT_EQ(cheapest_below(all, 0.01, 10)->method.substeps, 2);
    EXPECT_EQ(cheapest_below(all, 0.012, 10)->method.substeps, 1);
}

TEST(CheapestBelow, PaysForSettingUpOnce) {
    const std::vector<Tried> all{tried(1, 0.01, 1, 0, 20), tried(2, 0.01, 2)};
    EXPECT_EQ(cheapest_below(all, 0.1, 10)->method.substeps, 2);
    EXPECT_EQ(cheapest_below(all, 0.1, 30)->method.substeps, 1);
}

TEST(CheapestBelow, NeverTakesAnErrorThatIsNotKnown) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(cheapest_below(std::vector{tried(1, unknown, 1)}, 1, 10), std::nullopt);
}

TEST(MostExact, HasTheLeastOfTheLargestErrors) {
    const std::vector<Tried> all{tried(1, 0.01, 1, 0.5), tried(2, 0.1, 2, 0.1), tried(4, 0.3, 1)};
    EXPECT_EQ(most_exact(all).method.substeps, 2);
}

TEST(ExpectedAverageError, IsKnownOnceTheWholeRunHasBeenTried) {
    const Expected known = expected_average_error({.exact = {100, 100, 200}, .other = {100, 90, 190}}, 3);
    EXPECT_NEAR(known.error, 0.05, 1e-12);
    EXPECT_EQ(known.margin, 0);
}

TEST(ExpectedAverageError, GoesOnAsTheSecondHalfOfTheTrial) {
    const Expected later = expected_average_error({.exact = {100, 100}, .other = {100, 80}}, 10);
    EXPECT_DOUBLE_EQ(later.error, 1 - (100 + 9 * 80) / 1000.0);
    EXPECT_DOUBLE_EQ(later.margin, 2 * 0.8 * std::sqrt(2.0 / 100 + 2.0 / 800));
    const Expected faster = expected_average_error({.exact = {100, 100}, .other = {100, 120}}, 10);
    EXPECT_NEAR(faster.error, later.error, 1e-12) << "without sign";
}

TEST(ExpectedAverageError, LeavesMoreOpenWhereItIsOfAPiece) {
    const Expected piece = expected_average_error({.exact = {100, 100}, .other = {100, 80}}, 2, 10);
    EXPECT_DOUBLE_EQ(piece.error, 0.1);
    EXPECT_DOUBLE_EQ(piece.margin, 2 * std::sqrt(2.0 / 100 + 2.0 / 2000));
}

TEST(ExpectedAverageError, IsWithoutBoundWhereNothingShouldCollide) {
    EXPECT_EQ(expected_average_error({.exact = {0, 0}, .other = {0, 0}}, 2).error, 0);
    EXPECT_EQ(expected_average_error({.exact = {0, 0}, .other = {0, 1}}, 2).error,
              std::numeric_limits<double>::infinity());
    EXPECT_EQ(expected_average_error({.exact = {0, 0}, .other = {0, 0}}, 3).error,
              std::numeric_limits<double>::infinity())
        << "what did not happen so far may happen yet";
    const Expected late = expected_average_error({.exact = {3, 0}, .other = {3, 0}}, 4);
    EXPECT_FALSE(late.error + late.margin <= 1) << "nothing is known of what is still to come";
}

TEST(ExpectedAverageError, IsLessSureOfFewLargeAmountsThanOfManySmallOnes) {
    const Expected small = expected_average_error({.exact = {100, 100}, .other = {100, 80}}, 10);
    const Expected large = expected_average_error({.exact = {100, 100}, .other = {100, 80}, .grain = 9}, 10);
    EXPECT_DOUBLE_EQ(large.error, small.error);
    EXPECT_DOUBLE_EQ(large.margin, 3 * small.margin);
}

TEST(GrainOfImpulse, IsThatOfEquilibrium) {
    double sum = 0;
    double squares = 0;
    constexpr int count = 100'000;
    for (int n = 0; n < count; ++n) {
        // Velocities across a wall of those that arrive there, in equal steps of their distribution.
        const double impulse = 2 * std::sqrt(-2 * std::log1p(-(n + 0.5) / count));
        sum += impulse;
        squares += impulse * impulse;
    }
    EXPECT_NEAR(grain_of_impulse(sum, count), squares / sum, 1e-3 * squares / sum);
    EXPECT_EQ(grain_of_impulse(0, 0), 0);
}

/// Discs that are apart, none of which any number in the program was fitted to.
Scene unseen(std::uint64_t seed) {
    constexpr std::array<double, 4> area_fractions{0.05, 0.2, 0.45, 0.7};
    constexpr std::array<int, 3> counts{200, 500, 1100};
    const double area_fraction = area_fractions[seed % area_fractions.size()];
    const int count = counts[seed % counts.size()];
    return generate({.count = count,
                     .side = std::sqrt(count * std::numbers::pi / area_fraction),
                     .radius = 1,
                     .steps = 8,
                     .least_velocity = 0.1,
                     .largest_velocity = 0.1 + 0.075 * static_cast<double>(seed % 12),
                     .seed = 1900 + seed,
                     .placement = area_fraction > 0.4 ? Placement::lattice : Placement::random,
                     .isotropic = true});
}

class KeptPromise : public testing::TestWithParam<Measure> {};

TEST_P(KeptPromise, OnScenesNotSeenBefore) {
    int kept = 0;
    int made = 0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const Scene scene = unseen(seed);
        for (const double bound : {0.1, 0.01, 1e-9}) {
            const Trial trial = try_methods(scene, {}, GetParam(), bound);
            const auto choice = cheapest_below(trial.tried, bound, scene.steps);
            ASSERT_TRUE(choice) << seed << ": the event-driven simulation reaches " << bound;
            const Method method = choice->method;
            const ErrorMeasures errors =
                measure_errors(scene, *method.variant, {.substeps = method.substeps});
            ++made;
            kept += tests::error_of(errors, GetParam()) <= bound ? 1 : 0;
        }
    }
    EXPECT_EQ(made, 36);
    EXPECT_GE(kept, GetParam() == Measure::path ? made : made - 3);
}

INSTANTIATE_TEST_SUITE_P(TryMethods, KeptPromise,
                         testing::Values(Measure::path, Measure::collision_rate, Measure::pressure),
                         [](const auto& now) {
                             return std::string(now.param == Measure::path             ? "path"
                                                : now.param == Measure::collision_rate ? "collision_rate"
                                                                                       : "pressure");
                         });

TEST(TryMethods, TriesNothingThatCostsMoreThanWhatReachesTheBound) {
    const Scene scene = unseen(3);
    const Trial trial = try_methods(scene, {}, Measure::path, 0.5);
    EXPECT_EQ(trial.tried.front().method.variant, &event_driven());
    for (const Tried& one : trial.tried) {
        EXPECT_EQ(one.method.substeps, 1) << one.method.variant->name << ": the first step is good enough";
    }
    EXPECT_TRUE(trial.whole_scene);
    EXPECT_EQ(trial.discs, scene.discs.size());
}

TEST(TryMethods, TriesFewSubstepsOfAllBeforeManyOfOne) {
    const Scene scene = unseen(1);
    const double out_of_reach = 1e-300;
    const Trial trial = try_methods(scene, {}, Measure::path, out_of_reach);
    std::vector<int> substeps;
    for (const Tried& one : trial.tried) {
        substeps.push_back(one.method.substeps);
    }
    EXPECT_TRUE(std::ranges::is_sorted(substeps));
    EXPECT_EQ(std::ranges::count(substeps, 1), 5) << "event-driven, and each variant that is tried";
    EXPECT_GT(substeps.back(), 1);
}

TEST(TryMethods, TriesAllOfALargeSceneWhoseRunCostsLittle) {
    const Scene scene = generate({.count = static_cast<int>(largest_trial(Measure::collision_rate)) + 1000,
                                  .side = 600,
                                  .radius = 1,
                                  .steps = 8,
                                  .least_velocity = 0.1,
                                  .largest_velocity = 0.2,
                                  .seed = 7,
                                  .placement = Placement::random,
                                  .isotropic = true});
    const Trial trial = try_methods(scene, {}, Measure::collision_rate, 0.5);
    EXPECT_TRUE(trial.whole_scene);
    EXPECT_EQ(trial.units_of_time, 8);
    for (const Tried& one : trial.tried) {
        EXPECT_EQ(one.margin, 0) << one.method.variant->name;
    }
}

} // namespace
} // namespace carom
