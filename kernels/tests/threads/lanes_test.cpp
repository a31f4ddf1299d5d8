#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/threads/lanes.hpp"

namespace carom {
namespace {

Lanes<int> lanes_of(const std::vector<std::vector<int>>& turns) {
    Lanes<int> lanes(static_cast<int>(turns.size()), 0);
    for (const std::vector<int>& lane : turns) {
        for (const int turn : lane) {
            lanes.add(turn);
        }
        lanes.end_lane();
    }
    return lanes;
}

constexpr auto always = [](int) { return true; };

TEST(Lanes, KeepTheirTurnsInOrder) {
    const Lanes<int> lanes = lanes_of({{3, 1}, {}, {4}});
    ASSERT_EQ(lanes.lanes(), 3);
    EXPECT_TRUE(std::ranges::equal(lanes.turns(0), std::vector{3, 1}));
    EXPECT_TRUE(lanes.turns(1).empty());
    EXPECT_TRUE(std::ranges::equal(lanes.turns(2), std::vector{4}));
}

TEST(Lanes, GiveEachTurnOnceOwnOnesFirst) {
    Lanes<int> lanes = lanes_of({{0, 1}, {2, 3}, {4, 5}});
    std::vector<int> taken;
    for (int turn = lanes.take(1, always); turn >= 0; turn = lanes.take(1, always)) {
        taken.push_back(turn);
    }
    EXPECT_EQ(taken, (std::vector{2, 3, 4, 5, 0, 1}));
    EXPECT_EQ(lanes.take(0, always), Lanes<int>::done);
    EXPECT_EQ(lanes.take_from(0, always), Lanes<int>::done);
}

TEST(Lanes, TakeNoTurnThatCannotBegin) {
    Lanes<int> lanes = lanes_of({{0, 1}, {2}});
    const auto is_two = [](int turn) { return turn == 2; };
    EXPECT_EQ(lanes.take_from(0, is_two), Lanes<int>::wait);
    EXPECT_EQ(lanes.take(0, is_two), 2);
    EXPECT_EQ(lanes.take(0, is_two), Lanes<int>::wait);
    EXPECT_EQ(lanes.take(1, always), 0);
}

} // namespace
} // namespace carom
