#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "kernels/collide.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::Random;
using tests::same_bits;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
const ApproachTolerance relative(Tolerance::relative);
const ApproachTolerance published(Tolerance::published);

TEST(Overlap, CountsTouchingDiscsAndNoneFurtherApart) {
    const double radius = 1.5;
    const double reach_squared = 4 * radius * radius;
    EXPECT_TRUE(overlap({1, 2, 0, 0}, {4, 2, 0, 0}, reach_squared));
    EXPECT_TRUE(overlap({1, 2, 0, 0}, {1, -1, 0, 0}, reach_squared));
    EXPECT_TRUE(overlap({1, 2, 0, 0}, {1, 2, 0, 0}, reach_squared));
    EXPECT_TRUE(overlap({0, 0, 0, 0}, {1.8, 2.4, 0, 0}, reach_squared));
    EXPECT_FALSE(overlap({1, 2, 0, 0}, {std::nextafter(4.0, 5.0), 2, 0, 0}, reach_squared));
    EXPECT_FALSE(overlap({0, 0, 0, 0}, {2.5, 2.5, 0, 0}, reach_squared));
}

TEST(ResolvePair, TakesCoincidentCentresForNoCollision) {
    for (const double offset : {0.0, 5e-324, 1e-310, 1e-200}) {
        SCOPED_TRACE(offset);
        const Disc first{0, 0, 1, 2};
        const Disc second{offset, offset, -1, -3};
        Disc one = first;
        Disc two = second;
        EXPECT_FALSE(resolve_pair(one, two, relative));
        EXPECT_TRUE(same_bits(one, first));
        EXPECT_TRUE(same_bits(two, second));
    }
}

TEST(ResolveWalls, TurnsADiscWedgedBetweenTwoWallsEveryTime) {
    Disc disc{1, 1, 0.5, 0};
    for (const double vx : {-0.5, 0.5, -0.5}) {
        EXPECT_EQ(resolve_walls(disc, 2, 1), 1);
        EXPECT_EQ(disc.vx, vx);
    }
}

TEST(ToleranceOfApproach, PublishedIsAbsoluteAndRelativeIsNot) {
    const auto resolves = [](double speed, const ApproachTolerance<>& approach) {
        Disc first{0, 0, speed, 0};
        Disc second{1, 0, 0, 0};
        return resolve_pair(first, second, approach);
    };
    EXPECT_TRUE(resolves(1.1e-7, published));
    EXPECT_FALSE(resolves(1e-7, published));
    EXPECT_FALSE(resolves(0.9e-7, published));
    EXPECT_TRUE(resolves(0.9e-7, relative));
    EXPECT_TRUE(resolves(1e-60, relative));
}

TEST(ToleranceOfApproach, RelativeOverlooksWhatIsRoundingAtTheDiscsOwnSpeed) {
    const double speed = 1e10;
    Disc first{0, 0, speed * (1 + 2 * epsilon), 0};
    Disc second{1, 0, speed, 0};
    EXPECT_FALSE(resolve_pair(first, second, relative));
    EXPECT_TRUE(resolve_pair(first, second, published));
    first = {0, 0, speed * (1 + 1000 * epsilon), 0};
    second = {1, 0, speed, 0};
    EXPECT_TRUE(resolve_pair(first, second, relative));
}

TEST(ToleranceOfApproach, WhatSurelyCountsCounts) {
    Random random(11);
    int sure = 0;
    int counting = 0;
    for (int trial = 0; trial < 100'000; ++trial) {
        const double speed = std::ldexp(random.uniform(1, 2), static_cast<int>(random.uniform(-600, 600)));
        const double approach = -speed * epsilon * std::exp2(random.uniform(4, 16));
        const bool counts = relative.counts(approach, 1, speed * speed);
        if (relative.surely_counts(approach, speed * speed)) {
            EXPECT_TRUE(counts) << "approach " << approach << " at speed " << speed;
            ++sure;
        }
        counting += counts;
        EXPECT_FALSE(published.surely_counts(approach, speed * speed));
    }
    EXPECT_GT(sure, counting / 2); // it is worth asking first
    EXPECT_LT(sure, counting);
}

} // namespace
} // namespace carom
