#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "harness/accuracy/error_measures.hpp"
#include "harness/measure/measure.hpp"
#include "harness/tests/scenes/gas.hpp"
#include "harness/verify/event_driven_violation.hpp"
#include "kernels/exact/event_driven.hpp"
#include "kernels/tests/scenes.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {
namespace {

Scene apart(double area_fraction, std::uint64_t seed) {
    constexpr int count = 150;
    return tests::gas(count, tests::side_of(count, area_fraction), 12, 0.1, 1, seed);
}

Checker checker_of(const Scene& scene) {
    return {scene.side,       scene.radius,        1, Tolerance::relative, Rounding(),
            Impact::step_end, Engine::event_driven};
}

carom::Run checked(const Scene& scene, const Tuning& tuning = {}) {
    return checked_run(scene, event_driven(), tuning);
}

TEST(EventDrivenChecked, PassesFromDiluteToDenseAndWhereManyTouch) {
    for (const double area_fraction : {0.02, 0.1, 0.4, 0.65, 0.75}) {
        for (std::uint64_t seed = 1; seed < 6; ++seed) {
            EXPECT_EQ(checked(apart(area_fraction, seed)).violation, std::nullopt)
                << area_fraction << " " << seed;
        }
    }
    EXPECT_EQ(checked(tests::cradle()).violation, std::nullopt);
    EXPECT_EQ(checked(tests::corner()).violation, std::nullopt);
    EXPECT_EQ(checked(tests::scaled(apart(0.4, 7), 0x1p-20, 0x1p-30)).violation, std::nullopt);
}

TEST(EventDrivenChecked, EndsInTheSameBitsHoweverOftenItIsLookedAt) {
    const Scene scene = apart(0.5, 8);
    const auto once = checked(scene);
    for (const int threads : {1, 2}) {
        const Tuning tuning{.threads = threads, .substeps = 4};
        const auto simulation = event_driven().simulate(scene, tuning);
        for (const carom::Run& other :
             {run_scene(scene, *simulation, tuning, CheckScope::nothing), checked(scene, tuning)}) {
            EXPECT_EQ(once.discs, other.discs);
            EXPECT_EQ(once.work, other.work);
        }
    }
    EXPECT_GT(once.work.pair_resolves, 100);
    EXPECT_GT(once.work.wall_resolves, 10);
}

/// A disc as wide as its box is wedged when it meets the wall.
TEST(EventDrivenChecked, NamesTheStepInWhichADiscIsWedgedHoweverManyAreTakenAtOnce) {
    const Scene wedged{.side = 20, .radius = 10, .steps = 9, .discs = {{9.1, 10, 0.25, 0}}};
    const std::string said = "step 4: the collisions of one instant do not come to an end: a disc is wedged";
    EXPECT_EQ(checked(wedged).violation, said);
    for (const OnStep& on_step : {OnStep(), OnStep([](int, const Simulation&) {})}) {
        const auto simulation = event_driven().simulate(wedged, {});
        const carom::Run run =
            run_scene(wedged, *simulation, {}, {CheckScope::nothing, event_driven()}, on_step);
        EXPECT_EQ(run.violation, said);
    }
}

/// What the checker says of a unit of time whose end is changed by `mutate`.
template <class Mutate> std::string said_of(const Scene& scene, Mutate mutate) {
    EventDriven<double> exact(scene);
    exact.advance(1);
    std::vector<Disc> after = exact.discs();
    mutate(after);
    return checker_of(scene).step(scene.discs, after).value_or("nothing");
}

TEST(EventDrivenChecker, CatchesWhatIsPlanted) {
    const Scene scene = apart(0.4, 9);
    EXPECT_EQ(said_of(scene, [](auto&) {}), "nothing");
    const auto contains = [&](const char* part, auto mutate) {
        EXPECT_PRED_FORMAT2(testing::IsSubstring, part, said_of(scene, mutate));
    };
    contains("not finite", [](auto& discs) { discs[3].vx = std::numeric_limits<double>::quiet_NaN(); });
    contains("energy changed", [](auto& discs) { discs[3].vx *= 1 + 1e-6; });
    contains("overlap by", [](auto& discs) { discs[3] = discs[4]; });
    contains("overlaps a wall", [](auto& discs) { discs[3].x = 0.9; });
}

TEST(EventDrivenChecker, CatchesAPairThatFlewThroughEachOther) {
    const Scene scene{.side = 50, .radius = 1, .steps = 1, .discs = {{20, 20, 6, 0}, {24, 20.5, -6, 0}}};
    const auto fly = [](auto& discs) { discs = {{26, 20, 6, 0}, {18, 20.5, -6, 0}}; };
    EXPECT_EQ(said_of(scene, fly),
              "discs 0 and 1 come 1.5 too near each other, without a collision, at time 0.33333333333333331");
    EXPECT_EQ(said_of(scene, [](auto&) {}), "nothing");
}

TEST(EventDrivenChecker, LetsDiscsPassThatTouchOrMissEachOther) {
    const Scene grazing{.side = 50, .radius = 1, .steps = 1, .discs = {{20, 20, 6, 0}, {24, 22, -6, 0}}};
    EXPECT_EQ(said_of(grazing, [](auto&) {}), "nothing");
    const Scene one_after_another{
        .side = 50, .radius = 1, .steps = 1, .discs = {{20, 20, 6, 0}, {24, 14, 0, 6}}};
    EXPECT_EQ(said_of(one_after_another, [](auto&) {}), "nothing");
}

TEST(OverlapAtStart, NamesTheDiscsAndLetsThoseThatTouchPass) {
    EXPECT_EQ(overlap_at_start(tests::cradle()), std::nullopt) << "balls touch";
    EXPECT_EQ(overlap_at_start({.side = 10, .radius = 1, .steps = 1, .discs = {{1, 9, 0, 0}}}), std::nullopt);
    EXPECT_EQ(
        overlap_at_start({.side = 10, .radius = 1, .steps = 1, .discs = {{3, 3, 0, 0}, {4.5, 3, 0, 0}}}),
        "discs 0 and 1 overlap by 0.5");
    EXPECT_EQ(
        overlap_at_start({.side = 10, .radius = 1, .steps = 1, .discs = {{5, 5, 0, 0}, {9.25, 3, 0, 0}}}),
        "disc 1 overlaps a wall by 0.25");
}

TEST(EventDrivenErrors, AreTheRoundingOfDoubleAndNoZeroByConstruction) {
    for (const double area_fraction : {0.1, 0.65}) {
        const ErrorMeasures errors = measure_errors(apart(area_fraction, 10), event_driven(), {});
        ASSERT_TRUE(errors.reference);
        for (const DistanceAt& at : errors.reference->trajectory) {
            EXPECT_GT(at.rms_distance, 0) << at.time;
        }
        EXPECT_LT(errors.reference->trajectory[0].rms_distance, 1e-12);
        EXPECT_LT(std::abs(*errors.energy_drift), 1e-13);
        EXPECT_LT(*errors.momentum_drift, 1e-13) << "walls explain all of it";
        EXPECT_LT(errors.penetration_worst, 1e-12);
        EXPECT_NEAR(*errors.collision_rate, errors.reference->collision_rate, 1e-9);
        EXPECT_NEAR(*errors.pressure, errors.reference->pressure, 1e-9);
    }
}

} // namespace
} // namespace carom
