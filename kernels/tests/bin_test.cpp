#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/bin.hpp"
#include "kernels/move.hpp"
#include "kernels/probe.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

constexpr Policies sorted_discs{.storage = Storage::sorted};

State<sorted_discs> stepped(const Scene& scene, int steps, int threads) {
    State<sorted_discs> state(scene);
    NoProbe probe;
    for (int step = 0; step < steps; ++step) {
        move(state, {.threads = threads}, probe);
        bin(state, {.threads = threads}, probe);
    }
    return state;
}

TEST(SortedBin, IsStableAndSoTheSameForAnyNumberOfThreads) {
    const Scene scene = tests::random_scene(500, 60, 1, 1, 3, 52);
    const auto one = stepped(scene, 1, 1);
    for (std::size_t i = 1; i < one.numbers.size(); ++i) {
        const auto box = [&](std::size_t k) {
            return one.grid.box_of(one.grid.coordinate(one.discs[k].y), one.grid.coordinate(one.discs[k].x));
        };
        EXPECT_TRUE(box(i - 1) < box(i) || one.numbers[i - 1] < one.numbers[i]);
    }
    for (const int threads : {2, 3, 16, 600}) {
        EXPECT_EQ(stepped(scene, 1, threads).numbers, one.numbers) << threads << " threads";
    }
}

/// Of a scene that is full in one corner alone.
TEST(SortedBin, SharesBoxesAndDiscsAnewWhenItKnowsWhereTheyAre) {
    Scene scene = tests::random_scene(4000, 100, 0.5, 1, 0.1, 53);
    scene.side = 400;
    const auto state = stepped(scene, 2, 5);
    ASSERT_EQ(state.parts.size(), 6u);
    const int all = state.grid.box_count() + state.count();
    for (std::size_t k = 0; k < 5; ++k) {
        const auto& [begin, boxes, discs, total, place, leaving] = state.parts[k];
        EXPECT_LE(std::abs(5 * (boxes.count() + total) - all), all / 10) << k;
        EXPECT_LE(std::abs(discs.count() - total), 50) << k;
    }
}

TEST(SortedBin, IsTheSameWhenTheNumberOfThreadsChanges) {
    const Scene scene = tests::random_scene(500, 60, 1, 1, 3, 52);
    State<sorted_discs> state(scene);
    NoProbe probe;
    for (const int threads : {3, 1, 600, 2, 2}) {
        move(state, {.threads = threads}, probe);
        bin(state, {.threads = threads}, probe);
    }
    EXPECT_EQ(state.numbers, stepped(scene, 5, 1).numbers);
    state.restart(scene, 2);
    move(state, {.threads = 2}, probe);
    bin(state, {.threads = 2}, probe);
    EXPECT_EQ(state.numbers, stepped(scene, 1, 1).numbers);
}

/// Each count is written by one part: two of them share at most the line where one ends.
TEST(SortedBin, LetsEachPartWriteLinesOfItsOwn) {
    const auto state = stepped(tests::random_scene(4000, 100, 0.5, 1, 0.1, 54), 2, 4);
    const auto is_begin_of_line = [](const void* place) {
        return reinterpret_cast<std::uintptr_t>(place) % cache_line == 0;
    };
    EXPECT_TRUE(is_begin_of_line(state.box_begin.data()));
    EXPECT_TRUE(is_begin_of_line(state.discs.data()));
    for (const PartOfSort& part : state.parts) {
        EXPECT_TRUE(is_begin_of_line(&part));
    }
    for (std::size_t k = 1; k < 4; ++k) {
        EXPECT_EQ(state.parts[k].boxes.first, state.parts[k - 1].boxes.last);
        EXPECT_EQ(state.parts[k].discs.first, state.parts[k - 1].discs.last);
    }
}

} // namespace
} // namespace carom
