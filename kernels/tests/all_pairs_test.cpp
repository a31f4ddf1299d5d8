#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/tests/all_pairs.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::Outcome;
using tests::same_bits;
using tests::simulate;
using tests::simulate_all_pairs;

/// Calls `check` with every combination of neighbourhood, self-contained and direction for one order.
template <Order order, class Check> void for_each_combination(const Check& check) {
    const auto directions = [&]<Neighbourhood neighbourhood, SelfContained self_contained>() {
        check.template operator()<Policies{neighbourhood, order, self_contained, Direction::reverse}>();
        check.template operator()<Policies{neighbourhood, order, self_contained, Direction::forward}>();
    };
    directions.template operator()<Neighbourhood::four, SelfContained::on>();
    directions.template operator()<Neighbourhood::four, SelfContained::off>();
    directions.template operator()<Neighbourhood::nine, SelfContained::on>();
    directions.template operator()<Neighbourhood::nine, SelfContained::off>();
}

template <class Check> void for_each_order(const Check& check) {
    for_each_combination<Order::checkered>(check);
    for_each_combination<Order::row>(check);
    for_each_combination<Order::track>(check);
    for_each_combination<Order::repeat>(check);
    for_each_combination<Order::once>(check);
}

std::vector<Disc> reference_end(const Scene& scene) { return simulate_all_pairs(scene, Policies{}).discs; }

TEST(AllPairs, PassesTheBlowAlongTheCradle) {
    // The first disc comes to touch at x = 3.25, after one step; each of the others has 1/16 to go.
    const auto discs = reference_end({.side = 16,
                                      .radius = 1,
                                      .steps = 5,
                                      .discs = {{3, 5, 0.25, 0}, {5.125, 5, 0, 0}, {7.1875, 5, 0, 0}}});
    EXPECT_EQ(discs[0], (Disc{3.25, 5, 0, 0}));
    EXPECT_EQ(discs[1], (Disc{5.375, 5, 0, 0}));
    EXPECT_EQ(discs[2], (Disc{7.9375, 5, 0.25, 0}));
}

TEST(AllPairs, ReflectsADiscInTheCorners) {
    // At x = y = 1 after step 3, at 9 after step 11, at 1 after step 19, and then six steps more.
    EXPECT_EQ(reference_end(tests::corner())[0], (Disc{7, 7, 1, 1}));
}

TEST(AllPairs, GoesOnFromOneDiscToAThird) {
    // A carom, worked out by hand: disc 0 hits disc 1 at 45 degrees, turns to (0.5, -0.5), and with that hits
    // disc 2 straight below it, which takes over the downward part.
    const auto discs = reference_end(
        {.side = 20, .radius = 1, .steps = 1, .discs = {{4, 5, 1, 0}, {6, 6, 0, 0}, {5, 3.5, 0, 0}}});
    EXPECT_EQ(discs[0], (Disc{5, 5, 0.5, 0}));
    EXPECT_EQ(discs[1], (Disc{6, 6, 0.5, 0.5}));
    EXPECT_EQ(discs[2], (Disc{5, 3.5, 0, -0.5}));
}

/// In a scene of one box, discs and partners stand in the order of their numbers, as in the reference.
template <Order order> void is_the_reference_in_one_box() {
    for_each_combination<order>([]<Policies policies>() {
        for (std::uint64_t seed = 41; seed < 49; ++seed) {
            const Scene scene = tests::one_box_scene(seed);
            const Outcome variant = simulate<policies>(scene);
            const Outcome reference = simulate_all_pairs(scene, policies);
            ASSERT_TRUE(same_bits(variant.discs, reference.discs)) << "seed " << seed;
            ASSERT_EQ(variant.work.pair_resolves, reference.work.pair_resolves);
            ASSERT_EQ(variant.work.wall_resolves, reference.work.wall_resolves);
            ASSERT_EQ(variant.work.sweeps, reference.work.sweeps);
            ASSERT_GT(variant.work.pair_resolves, 20);
        }
    });
}

TEST(OneBox, OnceIsTheReference) { is_the_reference_in_one_box<Order::once>(); }
TEST(OneBox, RepeatIsTheReference) { is_the_reference_in_one_box<Order::repeat>(); }
TEST(OneBox, CheckeredIsTheReference) { is_the_reference_in_one_box<Order::checkered>(); }
TEST(OneBox, RowIsTheReference) { is_the_reference_in_one_box<Order::row>(); }

TEST(IsolatedPairs, EndInTheSameBitsInEveryOrder) {
    // Pairs on a lattice so wide that no third disc ever comes near: any order resolves the same collisions.
    tests::Random random(42);
    Scene scene{.side = 400, .radius = 1, .steps = 8, .discs = {}};
    for (int row = 0; row < 19; ++row) {
        for (int column = 0; column < 19; ++column) {
            const double x = 20 + 20 * column + random.uniform(-2, 2);
            const double y = 20 + 20 * row + random.uniform(-2, 2);
            const auto speed = [&random] { return random.uniform(-0.25, 0.25); };
            scene.discs.push_back({x, y, speed(), speed()});
            scene.discs.push_back({x + random.uniform(-2, 2), y + random.uniform(-2, 2), speed(), speed()});
        }
    }
    for_each_order([&scene]<Policies policies>() {
        const Outcome variant = simulate<policies>(scene);
        const Outcome reference = simulate_all_pairs(scene, policies);
        EXPECT_TRUE(same_bits(variant.discs, reference.discs));
        EXPECT_EQ(variant.work.pair_resolves, reference.work.pair_resolves);
        EXPECT_GT(variant.work.pair_resolves, 100);
    });
}

TEST(SingleDiscs, EndInTheSameBitsInEveryOrder) {
    const Scene scene = tests::random_scene(1, 7, 1, 200, 3, 43);
    for_each_order([&scene]<Policies policies>() {
        EXPECT_TRUE(same_bits(simulate<policies>(scene).discs, reference_end(scene)));
    });
}

} // namespace
} // namespace carom
