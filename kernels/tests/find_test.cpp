#include <algorithm>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/find.hpp"
#include "kernels/move.hpp"
#include "kernels/probe.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::all_scenes;
using tests::same_bits;

using Lists = std::vector<std::vector<int>>;

/// Every disc's partners in the order of their numbers, found by looking at all pairs.
Lists brute_force(const std::vector<Disc>& discs, double radius) {
    Lists lists(discs.size());
    for (std::size_t i = 0; i < discs.size(); ++i) {
        for (std::size_t j = 0; j < discs.size(); ++j) {
            const double dx = discs[i].x - discs[j].x;
            const double dy = discs[i].y - discs[j].y;
            if (i != j && dx * dx + dy * dy <= 2 * radius * (2 * radius)) {
                lists[i].push_back(static_cast<int>(j));
            }
        }
    }
    return lists;
}

Lists sorted(Lists lists) {
    for (auto& list : lists) {
        std::ranges::sort(list);
    }
    return lists;
}

std::int64_t pairs_in(const Lists& lists) {
    std::int64_t entries = 0;
    for (const auto& list : lists) {
        entries += static_cast<std::int64_t>(list.size());
    }
    return entries / 2;
}

constexpr Policies only_find{.self_contained = SelfContained::off};
constexpr Policies only_find_in_nine{.neighbourhood = Neighbourhood::nine,
                                     .self_contained = SelfContained::off};

template <Policies policies = only_find> State<policies> moved(const Scene& scene) {
    State<policies> state(scene);
    NoProbe probe;
    move(state, {}, probe);
    bin(state, {}, probe);
    return state;
}

template <Policies policies> Tally find_in(State<policies>& state) {
    NoProbe probe;
    return find(state, {}, probe);
}

template <Policies policies> void finds_what_looking_at_all_pairs_finds() {
    for (const auto& [name, scene] : all_scenes()) {
        SCOPED_TRACE(name);
        State<policies> state = moved<policies>(scene);
        const Tally tally = find_in(state);
        const Lists expected = brute_force(state.discs, scene.radius);
        EXPECT_EQ(sorted(state.overlaps), expected);
        EXPECT_EQ(tally.overlaps, pairs_in(expected));
        EXPECT_EQ(tally.pair_resolves, 0);
        EXPECT_TRUE(same_bits(state.discs, moved(scene).discs));
    }
}

TEST(Find, InNineBoxesFindsEveryOverlap) { finds_what_looking_at_all_pairs_finds<only_find_in_nine>(); }

TEST(Find, InFourBoxesFindsEveryOverlap) { finds_what_looking_at_all_pairs_finds<only_find>(); }

TEST(Find, ListsPartnersInTheSameOrderInBothNeighbourhoods) {
    for (const auto& [name, scene] : all_scenes()) {
        SCOPED_TRACE(name);
        State four = moved(scene);
        State nine = moved<only_find_in_nine>(scene);
        find_in(four);
        find_in(nine);
        EXPECT_EQ(four.overlaps, nine.overlaps);
    }
}

TEST(Find, ListsPartnersInTheOrderOfTheirNumbersWithinABox) {
    State state = moved(tests::one_box_scene(31));
    ASSERT_EQ(state.grid.box_count(), 1);
    find_in(state);
    EXPECT_EQ(state.overlaps, brute_force(state.discs, state.radius));
    EXPECT_GT(pairs_in(state.overlaps), 3);
}

TEST(Find, ForgetsTheOverlapsOfTheStepBefore) {
    State state = moved(tests::random_scene(100, 40, 1, 1, 1, 32));
    find_in(state);
    find_in(state);
    EXPECT_EQ(sorted(state.overlaps), brute_force(state.discs, state.radius));
}

TEST(SelfContainedFind, ResolvesPairsWithinABoxAndNoOthers) {
    // Boxes of side 5: discs 0 and 1 share one, 2 and 3 overlap across the edge at x = 15. All approach.
    const Scene scene{.side = 50,
                      .radius = 1,
                      .steps = 1,
                      .discs = {{6, 7, 0.5, 0}, {7.5, 7, -0.25, 0}, {14.5, 22, 0.25, 0}, {15.5, 22, 0, 0}}};
    State state = moved<Policies{}>(scene);
    const Tally tally = find_in(state);
    EXPECT_EQ(tally.overlaps, 2);
    EXPECT_EQ(tally.pair_resolves, 1);
    EXPECT_EQ(state.discs[0].vx, -0.25);
    EXPECT_EQ(state.discs[1].vx, 0.5);
    EXPECT_EQ(state.discs[2].vx, 0.25);
    EXPECT_EQ(state.discs[3].vx, 0);
}

TEST(SelfContainedFind, FindsTheSameOverlaps) {
    for (const auto& [name, scene] : all_scenes()) {
        SCOPED_TRACE(name);
        State on = moved<Policies{}>(scene);
        State off = moved(scene);
        find_in(on);
        find_in(off);
        EXPECT_EQ(on.overlaps, off.overlaps);
    }
}

} // namespace
} // namespace carom
