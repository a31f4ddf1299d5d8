#include <gtest/gtest.h>

#include "kernels/exact/tile_grid.hpp"

namespace carom::tests {
namespace {

TEST(TileGrid, AreasReachAsFarAsTheBox) {
    const TileGrid<double> grid(90, {.columns = 3, .rows = 1});
    const auto at_left = grid.area_around(0, 5);
    EXPECT_EQ(at_left.left, 0);
    EXPECT_EQ(at_left.width, 35);
    const auto middle = grid.area_around(1, 5);
    EXPECT_EQ(middle.left, 25);
    EXPECT_EQ(middle.width, 40);
    EXPECT_EQ(middle.bottom, 0);
    EXPECT_EQ(middle.height, 90);
    EXPECT_EQ(grid.area_around(2, 5).left + grid.area_around(2, 5).width, 90);
    EXPECT_EQ(middle.size(), 40 * 90);
}

TEST(TileGrid, APointIsInTheTileWhoseBoundsHoldIt) {
    const TileGrid<double> grid(90, {.columns = 3, .rows = 2});
    for (int tile = 0; tile < grid.count(); ++tile) {
        const auto [left, bottom, width, height] = grid.area_around(tile, 0);
        EXPECT_EQ(grid.tile_at({left + width / 2, bottom + height / 2}), tile);
    }
    EXPECT_EQ(grid.tile_at({-1, -1}), 0);
    EXPECT_EQ(grid.tile_at({91, 1000}), 5);
}

} // namespace
} // namespace carom::tests
