#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "kernels/collide.hpp"
#include "kernels/find.hpp"
#include "kernels/grid.hpp"
#include "kernels/tests/random_grid.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::Box;
using tests::Random;
using tests::random_box;
using tests::random_position;
using tests::random_rest;
using tests::some_ulps_from;

/// A partner of the disc at most 2r away, often by exactly 2r along an axis.
Disc random_partner(const Disc& disc, double radius, Random& random) {
    const double angle =
        random.below(2) * random.uniform(0, 2 * std::numbers::pi) + random.below(4) * std::numbers::pi / 2;
    const double distance = random.coin() ? 2 * radius : random.uniform(0, 2 * radius);
    return {disc.x + distance * std::cos(angle), disc.y + distance * std::sin(angle), 0, 0};
}

template <Neighbourhood neighbourhood> bool looks_at(const Grid& grid, double position, double other) {
    const BoxRange range = Look<neighbourhood>::along(grid, position, grid.coordinate(position));
    const int index = grid.coordinate(other);
    return range.first <= index && index <= range.last;
}

template <Neighbourhood neighbourhood> bool sees(const Grid& grid, const Disc& disc, const Disc& other) {
    return looks_at<neighbourhood>(grid, disc.x, other.x) && looks_at<neighbourhood>(grid, disc.y, other.y);
}

TEST(Grid, HasBoxesOfAtLeastFourRadiiThatCoverTheSide) {
    Random random(21);
    for (int trial = 0; trial < 2'000; ++trial) {
        const Box box = random_box(random);
        const Grid grid(box.side, box.radius);
        ASSERT_GE(grid.box_side(), 4 * box.radius);
        ASSERT_GE(grid.boxes_per_side() * grid.box_side(), box.side);
        ASSERT_GE(grid.boxes_per_side(), 1);
        const Grid wider(box.side, box.radius, 1, BoxSide::wide, Rest::in_last_box);
        ASSERT_EQ(wider.box_side(), grid.box_side());
        ASSERT_GE((wider.boxes_per_side() + 1) * wider.box_side(), box.side);
    }
}

TEST(Grid, HasAtMost4096BoxesAlongASide) {
    const Grid grid(1e60, 1e-60);
    EXPECT_EQ(grid.boxes_per_side(), 4096);
    EXPECT_EQ(grid.coordinate(1e60), 4095);
    EXPECT_EQ(grid.coordinate(0.5e60), 2048);
    EXPECT_TRUE(grid.at_wall(4095, 7));
}

/// What a grid owes to a disc of a random scene: neighbours that hold every partner, whichever of the two
/// looks, and `at_wall` of the box of every disc at a wall.
template <Neighbourhood... neighbourhoods, class MakeGrid>
void holds_partners_and_walls(std::uint64_t seed, const MakeGrid& make_grid) {
    Random random(seed);
    int across = 0;
    int at_wall = 0;
    for (int trial = 0; trial < 3'000; ++trial) {
        const Box box = random_box(random);
        const Grid grid = make_grid(box, random);
        for (int pair = 0; pair < 50; ++pair) {
            const Disc disc{random_position(box, grid, random), random_position(box, grid, random), 0, 0};
            const Disc partner = random_partner(disc, box.radius, random);
            if (overlap(disc, partner, 4 * box.radius * box.radius)) {
                across += grid.coordinate(disc.x) != grid.coordinate(partner.x);
                ASSERT_TRUE((sees<neighbourhoods>(grid, disc, partner) && ...)) << disc << " and " << partner;
                ASSERT_TRUE((sees<neighbourhoods>(grid, partner, disc) && ...)) << disc << " and " << partner;
            }
            if (overlaps_wall(disc, box.side, box.radius)) {
                ++at_wall;
                ASSERT_TRUE(grid.at_wall(grid.coordinate(disc.y), grid.coordinate(disc.x))) << disc;
            }
        }
    }
    EXPECT_GT(across, 5'000) << "too few pairs lie in different boxes for this test to mean anything";
    EXPECT_GT(at_wall, 5'000);
}

TEST(Grid, HoldsPartnersInNeighboursAndDiscsAtWallsInBoxesAtTheWall) {
    holds_partners_and_walls<Neighbourhood::nine, Neighbourhood::four>(
        23, [](const Box& box, Random& random) {
            return Grid(box.side, box.radius, 1, BoxSide::wide, random_rest(random));
        });
}

TEST(SnugGrid, HoldsPartnersInNeighboursAndDiscsAtWallsInBoxesAtTheWall) {
    holds_partners_and_walls<Neighbourhood::nine>(25, [](const Box& box, Random& random) {
        const Grid grid(box.side, box.radius, random.below(5'000) + 1, BoxSide::snug);
        EXPECT_GT(grid.box_side(), 2 * box.radius);
        return grid;
    });
}

TEST(SnugGrid, HasBoxesForItsDiscsAndNotForEmptySpace) {
    EXPECT_EQ(Grid(10'000, 16, 100'000, BoxSide::snug).boxes_per_side(), 313); // 10000 / 32, rounded up
    EXPECT_LE(Grid(1e60, 16, 100, BoxSide::snug).boxes_per_side(), 11);
    EXPECT_EQ(Grid(1e60, 16, 0, BoxSide::snug).boxes_per_side(), 1);
}

TEST(SnugGrid, HasNoScale) {
    for (const double scale : {0x1p-20, 0x1p20, 0x1p-300}) {
        const Grid one(100, 1.5, 700, BoxSide::snug);
        const Grid scaled(100 * scale, 1.5 * scale, 700, BoxSide::snug);
        EXPECT_EQ(scaled.box_side(), one.box_side() * scale);
        EXPECT_EQ(scaled.boxes_per_side(), one.boxes_per_side());
    }
}

TEST(GridNeighbours, AreNoMoreThanTheNeighbourhoodAllows) {
    const Grid grid(50, 1);
    for (int quarters = -12; quarters < 212; ++quarters) {
        const double position = quarters / 4.0;
        const int index = grid.coordinate(position);
        const BoxRange nine = Look<Neighbourhood::nine>::along(grid, position, index);
        const BoxRange four = Look<Neighbourhood::four>::along(grid, position, index);
        EXPECT_EQ(nine.first, std::max(index - 1, 0));
        EXPECT_EQ(nine.last, std::min(index + 1, 9));
        EXPECT_LE(four.last - four.first, 1);
        EXPECT_GE(four.first, nine.first);
        EXPECT_LE(four.last, nine.last);
    }
}

TEST(GridAtWall, DoesNotHoldInTheMiddle) {
    const Grid grid(50, 1);
    for (int row = 1; row < 9; ++row) {
        for (int column = 1; column < 9; ++column) {
            EXPECT_FALSE(grid.at_wall(row, column)) << row << ", " << column;
        }
    }
    for (int index = 0; index < 10; ++index) {
        EXPECT_TRUE(grid.at_wall(0, index));
        EXPECT_TRUE(grid.at_wall(9, index));
        EXPECT_TRUE(grid.at_wall(index, 0));
        EXPECT_TRUE(grid.at_wall(index, 9));
    }
}

TEST(GridAtWall, HoldsInTheLastButOneRowWhereTheLastIsNarrowerThanARadius) {
    const Grid grid(50.5,
                    1); // eleven boxes of side 5, the last with only half a length unit of the scene in it
    ASSERT_EQ(grid.boxes_per_side(), 11);
    EXPECT_EQ(grid.coordinate(49.6), 9);
    EXPECT_TRUE(grid.at_wall(9, 4));
    EXPECT_FALSE(grid.at_wall(8, 4));
}

/// No memory is needed to see that no index overflows, under UBSan.
TEST(Grid, OfAHundredMillionDiscsHasIndicesThatAnIntHolds) {
    constexpr int count = 100'000'000;
    for (const double fraction : {1e-9, 0.2, 0.8}) {
        for (const BoxSide choice : {BoxSide::wide, BoxSide::snug}) {
            const double side = std::sqrt(count * std::numbers::pi / fraction);
            const Grid grid(side, 1, count, choice);
            const int last = grid.boxes_per_side() - 1;
            EXPECT_EQ(grid.box_of(last, last) + 1, grid.box_count());
            EXPECT_GT(grid.box_count() + 1, 0);
            EXPECT_EQ(grid.rows_of_strip(grid.strip_count(4) - 1, 4).last, last);
            EXPECT_EQ(grid.coordinate(side), last);
        }
    }
}

TEST(Grid, OfTheMostBoxesHasIndicesThatAnIntHolds) {
    const Grid grid(1e9, 1e-6, std::numeric_limits<int>::max(), BoxSide::snug);
    EXPECT_EQ(grid.boxes_per_side(), 32768);
    EXPECT_EQ(grid.box_of(32767, 32767) + 1, grid.box_count());
    EXPECT_GT(grid.box_count() + 1, 0);
}

} // namespace
} // namespace carom
