#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "kernels/grid.hpp"
#include "kernels/state.hpp"
#include "kernels/tests/random_grid.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

using tests::Random;
using tests::random_position;

TEST(PublishedGrid, PutsTheRestWhereItIsTold) {
    EXPECT_EQ(Grid(52, 1, 1, BoxSide::wide, Rest::own_box).boxes_per_side(), 11);
    EXPECT_EQ(Grid(50, 1, 1, BoxSide::wide, Rest::own_box).boxes_per_side(), 10);
    const Grid wider(52, 1, 1, BoxSide::wide, Rest::in_last_box);
    EXPECT_EQ(wider.boxes_per_side(), 10);
    EXPECT_EQ(wider.coordinate(44.9), 8);
    EXPECT_EQ(wider.coordinate(51.9), 9);
    EXPECT_EQ(Grid(3, 1, 1, BoxSide::wide, Rest::in_last_box).boxes_per_side(), 1);
    EXPECT_EQ(Grid(1e60, 1e-60, 1, BoxSide::wide, Rest::in_last_box).boxes_per_side(), 4096);
}

/// What the published program computes, in its own words.
TEST(PublishedGrid, IsThatOfThePublishedProgramForEveryPosition) {
    Random random(26);
    for (int trial = 0; trial < 2'000; ++trial) {
        const int radius = random.below(60) + 1;
        const int side = (4 * radius + 1) * (random.below(30) + 1) + random.below(4 * radius + 1);
        const int width = 4 * radius + 1;
        const Grid grid(side, radius);
        for (int one = 0; one < 50; ++one) {
            const double position =
                random_position({static_cast<double>(side), static_cast<double>(radius)}, grid, random);
            if (std::abs(position) < 1e9) {
                const bool rounded_up = std::trunc(position / width) * width > position && position > 0;
                const int upper = !rounded_up && std::fmod(position, width) >= width / 2.0 ? 1 : -1;
                ASSERT_EQ(grid.nearer_side(position), upper) << position << " in boxes of " << width;
                ASSERT_EQ(grid.coordinate(position),
                          std::clamp(static_cast<int>(position / width), 0, grid.boxes_per_side() - 1))
                    << position << " in boxes of " << width;
            }
        }
    }
}

} // namespace
} // namespace carom
