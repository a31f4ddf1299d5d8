#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/collide.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::same_bits;

constexpr double side = 10;
constexpr double radius = 1;

struct Case {
    const char* what;
    Disc disc;
    double vx; ///< afterwards
    double vy;
    int turned;
};

TEST(ResolveWalls, TurnsExactlyTheComponentsThatMoveIntoAWall) {
    const std::vector<Case> cases{
        {"touches the low x wall", {1, 5, -2, 3}, 2, 3, 1},
        {"touches the high x wall", {9, 5, 2, -3}, -2, -3, 1},
        {"touches the low y wall", {5, 1, 2, -3}, 2, 3, 1},
        {"touches the high y wall", {5, 9, -2, 3}, -2, -3, 1},
        {"overlaps the low x wall, moves away", {0.5, 5, 2, 3}, 2, 3, 0},
        {"overlaps the high y wall, moves away", {5, 9.5, 2, -3}, 2, -3, 0},
        {"touches a wall, moves along it", {1, 5, 0, -3}, 0, -3, 0},
        {"in the low corner", {1, 1, -2, -3}, 2, 3, 2},
        {"in the high corner", {9, 9, 2, 3}, -2, -3, 2},
        {"in a mixed corner", {9, 1, 2, -3}, -2, 3, 2},
        {"in a corner, moves into one wall only", {1, 1, -2, 3}, 2, 3, 1},
        {"outside, moves further out", {-30, 5, -2, 3}, 2, 3, 1},
        {"outside, comes back", {-30, 5, 2, 3}, 2, 3, 0},
        {"outside beyond a corner", {40, -30, 2, -3}, -2, 3, 2},
        {"far from every wall", {5, 5, -2, -3}, -2, -3, 0},
        {"just off the low x wall", {std::nextafter(1.0, 2.0), 5, -2, 3}, -2, 3, 0},
        {"just off the high x wall", {std::nextafter(9.0, 8.0), 5, 2, 3}, 2, 3, 0},
        {"at rest in a corner", {1, 1, 0, 0}, 0, 0, 0},
        {"at rest in a corner, with negative zeros", {1, 1, -0.0, -0.0}, -0.0, -0.0, 0}};
    for (const Case& one : cases) {
        SCOPED_TRACE(one.what);
        Disc disc = one.disc;
        EXPECT_EQ(resolve_walls(disc, side, radius), one.turned);
        EXPECT_TRUE(same_bits(disc, {one.disc.x, one.disc.y, one.vx, one.vy})) << disc;
        EXPECT_EQ(resolve_walls(disc, side, radius), 0) << "a disc once turned moves away";
    }
}

TEST(ResolveWalls, TurnsADiscWedgedBetweenTwoWallsEveryTime) {
    Disc disc{1, 1, 0.5, 0};
    for (const double vx : {-0.5, 0.5, -0.5}) {
        EXPECT_EQ(resolve_walls(disc, 2 * radius, radius), 1);
        EXPECT_EQ(disc.vx, vx);
    }
}

} // namespace
} // namespace carom
