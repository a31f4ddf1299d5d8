#include <algorithm>
#include <cmath>
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
Lists overlaps_by_brute_force(const std::vector<Disc>& discs, double radius) {
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
        const Lists expected = overlaps_by_brute_force(state.discs, scene.radius);
        EXPECT_EQ(sorted(state.overlaps), expected);
        EXPECT_EQ(tally.overlaps, pairs_in(expected));
        EXPECT_EQ(tally.pair_resolves, 0);
        EXPECT_TRUE(same_bits(state.discs, moved(scene).discs));
    }
}

TEST(Find, InNineBoxesFindsEveryOverlap) { finds_what_looking_at_all_pairs_finds<only_find_in_nine>(); }

TEST(Find, InFourBoxesFindsEveryOverlap) { finds_what_looking_at_all_pairs_finds<only_find>(); }

struct Offset {
    int row;
    int column;
};

/// The other boxes in the order in which the published program looks into them: of nine column by column, of
/// four along x, along y, diagonally, towards the half of the box that the disc lies in.
std::vector<Offset> offsets(Neighbourhood neighbourhood, const Grid& grid, const Disc& disc) {
    if (neighbourhood == Neighbourhood::nine) {
        return {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    }
    const auto half = [&grid](double position) {
        return std::fmod(position, grid.box_side()) >= grid.box_side() / 2 ? 1 : -1;
    };
    return {{0, half(disc.x)}, {half(disc.y), 0}, {half(disc.y), half(disc.x)}};
}

/// Every disc's partners: those of its own box by number, then those of one other box after the other.
template <Policies policies> Lists in_published_order(const State<policies>& state) {
    Lists lists = overlaps_by_brute_force(state.discs, state.radius);
    for (std::size_t i = 0; i < lists.size(); ++i) {
        const auto row_of = [&](std::size_t k) { return state.grid.coordinate(state.discs[k].y); };
        const auto column_of = [&](std::size_t k) { return state.grid.coordinate(state.discs[k].x); };
        const auto others = offsets(policies.neighbourhood, state.grid, state.discs[i]);
        std::ranges::stable_sort(lists[i], {}, [&](int partner) {
            const auto j = static_cast<std::size_t>(partner);
            const int rows = row_of(j) - row_of(i);
            const int columns = column_of(j) - column_of(i);
            const auto box = std::ranges::find_if(
                others, [&](Offset offset) { return offset.row == rows && offset.column == columns; });
            return rows == 0 && columns == 0 ? -1 : static_cast<int>(box - others.begin());
        });
    }
    return lists;
}

template <Policies policies> void lists_partners_in_the_published_order() {
    for (const auto& [name, scene] : all_scenes()) {
        SCOPED_TRACE(name);
        State<policies> state = moved<policies>(scene);
        find_in(state);
        EXPECT_EQ(state.overlaps, in_published_order(state));
    }
}

TEST(Find, InNineBoxesListsPartnersInThePublishedOrder) {
    lists_partners_in_the_published_order<only_find_in_nine>();
}

TEST(Find, InFourBoxesListsPartnersInThePublishedOrder) {
    lists_partners_in_the_published_order<only_find>();
}

TEST(Find, ListsPartnersInTheOrderOfTheirNumbersWithinABox) {
    State state = moved(tests::one_box_scene(31));
    ASSERT_EQ(state.grid.box_count(), 1);
    find_in(state);
    EXPECT_EQ(state.overlaps, overlaps_by_brute_force(state.discs, state.radius));
    EXPECT_GT(pairs_in(state.overlaps), 3);
}

TEST(Find, ForgetsTheOverlapsOfTheStepBefore) {
    State state = moved(tests::random_scene(100, 40, 1, 1, 1, 32));
    find_in(state);
    find_in(state);
    EXPECT_EQ(sorted(state.overlaps), overlaps_by_brute_force(state.discs, state.radius));
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

TEST(SelfContainedFind, LeavesNothingCollidingWithinABox) {
    int resolves = 0;
    for (const auto& [name, scene] : all_scenes()) {
        SCOPED_TRACE(name);
        State state = moved<Policies{}>(scene);
        resolves += static_cast<int>(find_in(state).pair_resolves);
        const auto box_of = [&](std::size_t i) {
            return state.grid.box_of(state.grid.coordinate(state.discs[i].y),
                                     state.grid.coordinate(state.discs[i].x));
        };
        for (std::size_t i = 0; i < state.discs.size(); ++i) {
            for (const int partner : state.overlaps[i]) {
                const auto j = static_cast<std::size_t>(partner);
                Disc one = state.discs[i];
                Disc two = state.discs[j];
                EXPECT_FALSE(box_of(i) == box_of(j) &&
                             resolve_pair(one, two, ApproachTolerance(Tolerance::relative)))
                    << i << " and " << j;
            }
        }
    }
    EXPECT_GT(resolves, 500);
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
