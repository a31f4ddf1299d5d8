#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/exact/agreement.hpp"

namespace carom::tests {
namespace {

/// Two by two tiles of side 50 in a box of side 100, discs of radius 1, a window from time 0 to 1. The left
/// lower tile owns disc 0; the right lower one owns discs 1 and 2, of which 1 starts nearer to the border
/// than the halo of 10, and 2 farther away.
class AgreementOfTiles : public testing::Test {
  protected:
    static constexpr double halo = 10;
    static constexpr int left = 0;
    static constexpr int right = 1;

    AgreementOfTiles() : tiles_(4), flights_(4) {
        for (int tile = 0; tile < grid_.count(); ++tile) {
            tiles_[static_cast<std::size_t>(tile)].bounds = grid_.bounds(tile);
            tiles_[static_cast<std::size_t>(tile)].flights = &flights_[static_cast<std::size_t>(tile)];
        }
        const std::vector<Flight<double>> flights{{.x = 45, .y = 20}, {.x = 53, .y = 20}, {.x = 85, .y = 20}};
        tiles_[left].held = {{0, left, 0}, {1, right, 1}};
        tiles_[left].kinds = {Kind::shared, Kind::copy};
        tiles_[left].remembered = {0, 1};
        flights_[left] = {flights[0], flights[1]};
        tiles_[right].held = {{0, left, 0}, {1, right, 1}, {2, right, 2}};
        tiles_[right].kinds = {Kind::copy, Kind::shared, Kind::own};
        tiles_[right].remembered = {0, 1};
        flights_[right] = flights;
        for (auto& tile : tiles_) {
            tile.begin();
        }
        tiles_[left].shared_is_at({45, 20});
        tiles_[right].shared_is_at({53, 20});
        tiles_[right].own_is_at({85, 20});
    }

    /// A disc meets a wall in one tile, and flies on from there so.
    void meets_wall(int tile, int place, double time, const Disc& after) {
        tiles_[static_cast<std::size_t>(tile)].will_change(
            place, flights_[static_cast<std::size_t>(tile)][static_cast<std::size_t>(place)]);
        tiles_[static_cast<std::size_t>(tile)].collided({time, 0, place, place, after, after});
    }

    /// Disc 1 begins there in both tiles.
    void begins_at(double x) { flights_[left][1].x = flights_[right][1].x = x; }

    bool agree() const {
        Window<double> window{.begin = 0, .end = 1, .halo = halo, .grid = grid_, .tiles = {}};
        for (const auto& tile : tiles_) {
            window.tiles.push_back(&tile);
        }
        const Agreement<double> agreement(window, 1);
        bool all = true;
        for (int tile = 0; tile < grid_.count(); ++tile) {
            all = agreement.of(tile) && all;
        }
        return all;
    }

    TileGrid<double> grid_{100, {.columns = 2, .rows = 2}};
    std::vector<TileHistory<double>> tiles_;
    std::vector<std::vector<Flight<double>>> flights_; ///< of each tile's discs
};

TEST_F(AgreementOfTiles, HoldsWhereNothingHappens) { EXPECT_TRUE(agree()); }

TEST_F(AgreementOfTiles, HoldsWhereACopyGoesThroughTheSame) {
    meets_wall(left, 1, 0.5, {53, 20, 1, 0});
    meets_wall(right, 1, 0.5, {53, 20, 1, 0});
    EXPECT_TRUE(agree());
}

TEST_F(AgreementOfTiles, FailsWhereACopyNearByMissesACollisionOrHasOneMore) {
    meets_wall(right, 1, 0.5, {51.9, 20, 1, 0});
    EXPECT_FALSE(agree());
    meets_wall(left, 1, 0.5, {51.9, 20, 1, 0});
    EXPECT_TRUE(agree());
    meets_wall(left, 1, 0.6, {51.9, 20, 1, 0});
    EXPECT_FALSE(agree());
}

TEST_F(AgreementOfTiles, FailsWhereACopyNearByDiffersInTheLastBit) {
    for (const Disc& other : {Disc{51.9, 20, 1 + 0x1p-52, 0}, Disc{51.9, 20, 1, 0x1p-1074}}) {
        tiles_[left].begin();
        tiles_[right].begin();
        meets_wall(left, 1, 0.5, {51.9, 20, 1, 0});
        meets_wall(right, 1, 0.5, other);
        EXPECT_FALSE(agree());
    }
}

TEST_F(AgreementOfTiles, FailsWhereACopyNearByCollidesAtAnotherTime) {
    meets_wall(left, 1, 0.5, {51.9, 20, 1, 0});
    meets_wall(right, 1, 0.6, {51.9, 20, 1, 0});
    EXPECT_FALSE(agree());
}

TEST_F(AgreementOfTiles, DoesNotAskForWhatACopyDoesFarAway) {
    begins_at(59);
    meets_wall(right, 1, 0.5, {59, 20, 1, 0});
    EXPECT_TRUE(agree());
    tiles_[right].begin();
    meets_wall(right, 1, 0.5, {59, 20, -20, 0});
    EXPECT_FALSE(agree()) << "the disc itself comes near by the end of the window";
    tiles_[right].begin();
    meets_wall(left, 1, 0.5, {59, 20, -20, 0});
    EXPECT_FALSE(agree()) << "its copy does";
}

TEST_F(AgreementOfTiles, AsksForFartherOnesWhereAnOwnedDiscComesOut) {
    begins_at(59);
    meets_wall(right, 1, 0.5, {59, 20, 1, 0});
    tiles_[left].shared_is_at({57, 20});
    EXPECT_FALSE(agree());
}

TEST_F(AgreementOfTiles, FailsWhereADiscWithoutACopyComesNear) {
    tiles_[right].own_is_at({51, 20});
    EXPECT_FALSE(agree());
}

/// Disc 1 has a copy in the tile beside it, and none in that above it.
TEST_F(AgreementOfTiles, FailsWhereADiscComesNearATileThatHasNoCopyOfIt) {
    meets_wall(left, 1, 0.1, {53, 49.5, 0, 0});
    meets_wall(right, 1, 0.1, {53, 49.5, 0, 0});
    EXPECT_FALSE(agree());
}

TEST_F(AgreementOfTiles, FailsWhereAnOwnedDiscComesFarOut) {
    tiles_[left].shared_is_at({73, 20});
    EXPECT_TRUE(agree());
    tiles_[left].shared_is_at({74.5, 20});
    EXPECT_FALSE(agree()) << "tiles beyond those beside it have no copy of it";
}

TEST_F(AgreementOfTiles, FailsWhereTheCollisionsOfAnInstantDidNotEnd) {
    tiles_[right].ended = false;
    EXPECT_FALSE(agree());
}

} // namespace
} // namespace carom::tests
