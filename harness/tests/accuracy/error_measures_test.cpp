#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harness/accuracy/error_measures.hpp"
#include "harness/accuracy/momentum_balance.hpp"
#include "harness/accuracy/penetration.hpp"
#include "harness/support/errors.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/registry.hpp"

namespace carom {
namespace {

const Variant& published = *find_variant("published");

const Walls walls{.side = 50, .radius = 1, .rounding = Rounding()};

/// One step whose velocities change from `before` to `after` at the positions of `after`.
MomentumBalance balance_of(const std::vector<Disc>& before, const std::vector<Disc>& after) {
    MomentumBalance balance(walls);
    balance.add(before, after, overlapping_pairs(after, walls.radius));
    return balance;
}

TEST(MomentumBalance, ExplainsAPair) {
    const auto balance =
        balance_of({{20, 20, 1, 0.5}, {21.5, 20, -1, 0}}, {{20, 20, -1, 0.5}, {21.5, 20, 1, 0}});
    EXPECT_EQ(balance.unexplained(), 0);
    EXPECT_EQ(balance.wall_impulse(), 0);
}

TEST(MomentumBalance, GivesAWallWhatItTurned) {
    for (const auto& [before, after] : {std::pair{Disc{0.5, 20, -2, 1}, Disc{0.5, 20, 2, 1}},
                                        std::pair{Disc{49.5, 20, 2, 1}, Disc{49.5, 20, -2, 1}},
                                        std::pair{Disc{20, 0.5, 1, -2}, Disc{20, 0.5, 1, 2}},
                                        std::pair{Disc{20, 49.5, 1, 2}, Disc{20, 49.5, 1, -2}}}) {
        const auto balance = balance_of({before}, {after});
        EXPECT_EQ(balance.unexplained(), 0);
        EXPECT_EQ(balance.wall_impulse(), 4);
    }
}

TEST(MomentumBalance, GivesAWallWhatReachedItThroughAnotherDisc) {
    const auto balance = balance_of({{1, 20, 0, 0}, {2.5, 20, -1, 0}}, {{1, 20, 0, 0}, {2.5, 20, 1, 0}});
    EXPECT_EQ(balance.unexplained(), 0);
    EXPECT_EQ(balance.wall_impulse(), 2);
}

TEST(MomentumBalance, DoesNotExplainWhatNoWallOfTheAxisTouches) {
    EXPECT_EQ(balance_of({{20, 20, 1, 0}}, {{20, 20, -1, 0}}).unexplained(), 2);
    EXPECT_EQ(balance_of({{0.5, 20, 1, 3}}, {{0.5, 20, 1, -1}}).unexplained(), 4);
}

TEST(MomentumBalance, CannotTellTheImpulsesOfAGroupFromWallToWall) {
    std::vector<Disc> row(25);
    for (std::size_t i = 0; i < row.size(); ++i) {
        row[i] = {1 + 2.0 * static_cast<double>(i), 20, 0, 0};
    }
    EXPECT_FALSE(balance_of(row, row).from_wall_to_wall());
    std::vector<Disc> pushed = row;
    pushed.back().vx = 1;
    EXPECT_TRUE(balance_of(pushed, row).from_wall_to_wall());
}

TEST(Penetration, CountsPairsThatWereApartAtTheStart) {
    const std::vector<Disc> discs{{10, 10, 0, 0}, {11.5, 10, 0, 0}, {20, 20, 0, 0}, {21, 20, 0, 0}};
    const auto pairs = overlapping_pairs(discs, 1);
    ASSERT_EQ(pairs.size(), 2u);
    Penetration all({}, 1);
    all.add(discs, pairs);
    EXPECT_DOUBLE_EQ(all.worst(), 1);
    EXPECT_DOUBLE_EQ(all.mean(), 0.75);
    all.add(discs, {{1, 0}});
    EXPECT_DOUBLE_EQ(all.mean(), 2.0 / 3);
    Penetration but_one({{3, 2}}, 1);
    but_one.add(discs, pairs);
    EXPECT_DOUBLE_EQ(but_one.worst(), 0.5);
    EXPECT_EQ(Penetration({}, 1).mean(), 0);
}

TEST(Penetration, IsInUnitsOfTheRadius) {
    Penetration scaled({}, 4);
    scaled.add({{10, 10, 0, 0}, {16, 10, 0, 0}}, {{0, 1}});
    EXPECT_DOUBLE_EQ(scaled.worst(), 0.5);
}

TEST(KolmogorovSmirnovDistance, IsTheLargestDifferenceOfShares) {
    EXPECT_EQ(kolmogorov_smirnov_distance({1, 2, 3}, {3, 1, 2}), 0);
    EXPECT_EQ(kolmogorov_smirnov_distance({1, 2, 3}, {4, 5}), 1);
    EXPECT_DOUBLE_EQ(kolmogorov_smirnov_distance({1, 2, 3, 4}, {1, 2, 3, 9}), 0.25);
    EXPECT_DOUBLE_EQ(kolmogorov_smirnov_distance({1, 1, 1, 2}, {1, 2, 2, 2}), 0.5);
    EXPECT_EQ(kolmogorov_smirnov_distance({0.25, 0}, {0.25 * (1 + 1e-15), 0}), 0);
    EXPECT_EQ(kolmogorov_smirnov_distance({}, {1}), 0);
}

/// A disc alone between walls 8 apart at speed 2 turns every 4 units of time, at the times 2, 6, 10 ...; a
/// step of 1/2 sees it at once, since it then touches.
TEST(MeasureErrors, FindsNoneWhereStepsEndAtTheCollisions) {
    const Scene scene{.side = 10, .radius = 1, .steps = 20, .discs = {{5, 5, 2, 0}}};
    const ErrorMeasures measures = measure_errors(scene, published, {.substeps = 2});
    EXPECT_EQ(measures.energy_drift, 0);
    EXPECT_EQ(measures.momentum_drift, 0);
    EXPECT_EQ(measures.penetration_worst, 0);
    EXPECT_EQ(measures.unresolved_pairs, 0);
    EXPECT_EQ(measures.collision_rate, 0);
    EXPECT_DOUBLE_EQ(measures.pressure.value(), 5 * 4 / (20 * 40.0));
    ASSERT_TRUE(measures.reference);
    EXPECT_DOUBLE_EQ(measures.reference->pressure, measures.pressure.value());
    std::vector<int> times;
    for (const DistanceAt& at : measures.reference->trajectory) {
        times.push_back(at.time);
        EXPECT_EQ(at.rms_distance, 0);
    }
    EXPECT_EQ(times, (std::vector{1, 2, 4, 8, 16, 20}));
    EXPECT_EQ(measures.reference->time_to_tenth_radius, std::nullopt);
    EXPECT_EQ(measures.reference->speed_distance, 0);
}

/// Head-on at a relative speed of 1, the surfaces 2.5 apart: the reference turns both back after 2.5, steps
/// of 1 after 3, at half a unit of depth and a distance of 2 * 1/2 * 1/2 each.
TEST(MeasureErrors, FindsWhatAStepIsLate) {
    const Scene scene{.side = 50, .radius = 1, .steps = 5, .discs = {{20, 20, 0.5, 0}, {24.5, 20, -0.5, 0}}};
    const ErrorMeasures measures = measure_errors(scene, published, {});
    EXPECT_DOUBLE_EQ(measures.penetration_worst, 0.5);
    EXPECT_DOUBLE_EQ(measures.penetration_mean, 0.5);
    EXPECT_DOUBLE_EQ(measures.collision_rate.value(), 1.0 / (2 * 5));
    ASSERT_TRUE(measures.reference);
    EXPECT_DOUBLE_EQ(measures.reference->collision_rate, 1.0 / (2 * 5));
    EXPECT_DOUBLE_EQ(measures.reference->trajectory.back().rms_distance, 0.5);
    EXPECT_EQ(measures.reference->time_to_tenth_radius, 3);
}

TEST(MeasureErrors, EndsInTheStateOfARunWithoutThem) {
    const Scene scene = tests::random_scene(200, 60, 1, 5, 1, 41);
    const Tuning tuning{.threads = 2, .substeps = 3};
    const ErrorMeasures measures = measure_errors(scene, published, tuning);
    EXPECT_TRUE(tests::same_bits(measures.discs, tests::simulate<Policies{}>(scene, tuning).discs));
    EXPECT_NEAR(measures.energy_drift.value(), 0, 1e-13);
    EXPECT_LT(measures.momentum_drift.value(), 1e-13);
    EXPECT_EQ(measures.unresolved_pairs, 0);
}

TEST(MeasureErrors, GivesTheReferenceUpAtItsLimitAndSaysSo) {
    const Scene scene = tests::random_scene(200, 60, 1, 5, 1, 41);
    const ErrorMeasures measures = measure_errors(scene, published, {}, 100);
    EXPECT_FALSE(measures.reference);
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "given up before time", measures.reference_reason);
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "of 5, after 100 collisions", measures.reference_reason);
    const auto json = error_measures_json(measures);
    EXPECT_TRUE(json["trajectory"].is_null());
    EXPECT_EQ(json["reference_reason"], measures.reference_reason);
    EXPECT_TRUE(json["energy_drift"].is_number());
}

TEST(MeasureErrors, FailsWhereAResolveDoesNotEnd) {
    const Scene wedged{.side = 2, .radius = 1, .steps = 3, .discs = {{0.5, 1, 0.5, 0}}};
    EXPECT_THROW(measure_errors(wedged, published, {.sweep_limit = 20}), CheckError);
}

TEST(MeasureErrors, LeavesEmptyWhatHasNoMeaning) {
    const Scene none{.side = 10, .radius = 1, .steps = 3, .discs = {}};
    const auto empty = error_measures_json(measure_errors(none, published, {}));
    for (const char* field :
         {"energy_drift", "momentum_drift", "collision_rate", "collision_rate_reference"}) {
        EXPECT_TRUE(empty[field].is_null()) << field;
    }
    EXPECT_EQ(empty["trajectory"].size(), 3u);
    const Scene unmoved{.side = 10, .radius = 1, .steps = 0, .discs = {{5, 5, 1, 0}}};
    const auto at_once = error_measures_json(measure_errors(unmoved, published, {}));
    EXPECT_TRUE(at_once["pressure"].is_null());
    EXPECT_EQ(at_once["pressure_reason"], "the scene has no steps");
    EXPECT_EQ(at_once["trajectory"].size(), 0u);
}

/// Henderson's equation (see kernels/tests/event_driven_test.cpp) needs a large box; here the run is held
/// against the reference of its own scene, for the same time.
TEST(MeasureErrors, PressureAndCollisionRateComeNearTheReferenceForSmallSteps) {
    Scene scene = tests::lattice_scene(12, 0.28, 44);
    scene.steps = 50;
    const ErrorMeasures measures = measure_errors(scene, published, {.substeps = 32});
    ASSERT_TRUE(measures.reference);
    ASSERT_TRUE(measures.pressure) << measures.pressure_reason;
    EXPECT_NEAR(measures.pressure.value() / measures.reference->pressure, 1, 0.1);
    EXPECT_NEAR(measures.collision_rate.value() / measures.reference->collision_rate, 1, 0.05);
    EXPECT_LT(measures.reference->speed_distance, 0.2);
}

} // namespace
} // namespace carom
