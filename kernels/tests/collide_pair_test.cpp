#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

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

double speed_sum(const Disc& first, const Disc& second) {
    return std::hypot(first.vx, first.vy) + std::hypot(second.vx, second.vy);
}

double energy(const Disc& first, const Disc& second) {
    return first.vx * first.vx + first.vy * first.vy + second.vx * second.vx + second.vy * second.vy;
}

/// Two discs nearer than 2 length units, at magnitudes of lengths and speeds of their own.
std::pair<Disc, Disc> random_pair(Random& random) {
    const double length = random.magnitude(-20, 20);
    const double speed = random.magnitude(-20, 20);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double distance = random.uniform(0.01, 2) * length;
    const double x = random.uniform(0, 10) * length;
    const double y = random.uniform(0, 10) * length;
    const auto component = [&] { return random.uniform(-speed, speed); };
    return {{x, y, component(), component()},
            {x + distance * std::cos(angle), y + distance * std::sin(angle), component(), component()}};
}

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

TEST(ResolvePair, ExchangesVelocitiesHeadOn) {
    Disc first{0, 0, 1, 0};
    Disc second{1, 0, -2, 0};
    EXPECT_TRUE(resolve_pair(first, second, relative));
    EXPECT_EQ(first, (Disc{0, 0, -2, 0}));
    EXPECT_EQ(second, (Disc{1, 0, 1, 0}));
}

TEST(ResolvePair, GivesAllVelocityToADiscAtRestInFront) {
    Disc first{5, 5, 0, 0.5};
    Disc second{5, 7, 0, 0};
    EXPECT_TRUE(resolve_pair(first, second, relative));
    EXPECT_EQ(first, (Disc{5, 5, 0, 0}));
    EXPECT_EQ(second, (Disc{5, 7, 0, 0.5}));
}

TEST(ResolvePair, StopsOnlyTheNormalPartOfAnObliqueHit) {
    // The line of centres is at 45 degrees: a hit along x leaves both at right angles with half the energy
    // each.
    Disc first{0, 0, 1, 0};
    Disc second{1, 1, 0, 0};
    EXPECT_TRUE(resolve_pair(first, second, relative));
    EXPECT_EQ(first, (Disc{0, 0, 0.5, -0.5}));
    EXPECT_EQ(second, (Disc{1, 1, 0.5, 0.5}));
}

TEST(ResolvePair, ExchangesNormalPartsAndKeepsTangentialOnesInEveryDirection) {
    for (int degrees = 0; degrees < 360; degrees += 5) {
        SCOPED_TRACE(degrees);
        const double angle = degrees * std::numbers::pi / 180;
        const double nx = std::cos(angle);
        const double ny = std::sin(angle);
        Disc first{3, 4, 0.75 * nx + 0.25 * ny, 0.75 * ny - 0.25 * nx};
        Disc second{3 + 1.5 * nx, 4 + 1.5 * ny, -0.5 * nx - 2 * ny, -0.5 * ny + 2 * nx};
        ASSERT_TRUE(resolve_pair(first, second, relative));
        EXPECT_NEAR(first.vx * nx + first.vy * ny, -0.5, 1e-14);
        EXPECT_NEAR(second.vx * nx + second.vy * ny, 0.75, 1e-14);
        EXPECT_NEAR(first.vx * ny - first.vy * nx, 0.25, 1e-14);
        EXPECT_NEAR(second.vx * ny - second.vy * nx, -2, 1e-14);
    }
}

TEST(ResolvePair, ConservesMomentumEnergyAndAngularMomentumAtEveryScale) {
    Random random(11);
    int resolved = 0;
    for (int trial = 0; trial < 20'000; ++trial) {
        const auto [first, second] = random_pair(random);
        Disc one = first;
        Disc two = second;
        const double dx = two.x - one.x;
        const double dy = two.y - one.y;
        resolved += resolve_pair(one, two, relative);
        const double speeds = speed_sum(first, second);
        ASSERT_NEAR(one.vx + two.vx, first.vx + second.vx, 8 * epsilon * speeds);
        ASSERT_NEAR(one.vy + two.vy, first.vy + second.vy, 8 * epsilon * speeds);
        ASSERT_NEAR(energy(one, two), energy(first, second), 32 * epsilon * speeds * speeds);
        // About the first centre, only the second disc has any; an impulse along d leaves it alone.
        ASSERT_NEAR(dx * (two.vy - second.vy), dy * (two.vx - second.vx),
                    32 * epsilon * std::hypot(dx, dy) * speeds);
    }
    EXPECT_GT(resolved, 8'000);
    EXPECT_LT(resolved, 12'000);
}

TEST(ResolvePair, LeavesNothingToResolve) {
    Random random(12);
    for (int trial = 0; trial < 20'000; ++trial) {
        auto [first, second] = random_pair(random);
        if (trial % 2 == 0) { // moving almost together: the difference of the velocities is mostly rounding
            second.vx = first.vx * (1 + random.uniform(-64, 64) * epsilon);
            second.vy = first.vy * (1 + random.uniform(-64, 64) * epsilon);
        }
        resolve_pair(first, second, relative);
        ASSERT_FALSE(resolve_pair(first, second, relative)) << first << " and " << second;
    }
}

TEST(ResolvePair, LeavesDiscsThatDoNotApproachAsTheyAre) {
    const Disc first{0, 0, 1, 1};
    for (const Disc& second : {Disc{1, 0, 1, 5}, Disc{1, 0, 2, -3}, Disc{1, 1, 1, 1}, Disc{1, -1, 3, 2}}) {
        Disc one = first;
        Disc two = second;
        EXPECT_FALSE(resolve_pair(one, two, relative)) << second;
        EXPECT_TRUE(same_bits(one, first));
        EXPECT_TRUE(same_bits(two, second));
    }
}

TEST(ResolvePair, GivesTheSameBitsWhicheverDiscComesFirst) {
    Random random(13);
    for (int trial = 0; trial < 20'000; ++trial) {
        const auto [first, second] = random_pair(random);
        Disc one = first;
        Disc two = second;
        Disc other_one = first;
        Disc other_two = second;
        const bool resolved = resolve_pair(one, two, relative);
        ASSERT_EQ(resolve_pair(other_two, other_one, relative), resolved);
        ASSERT_TRUE(same_bits(one, other_one));
        ASSERT_TRUE(same_bits(two, other_two));
    }
}

TEST(ResolvePair, DecidesTheSameInUnitsScaledByAPowerOfTwo) {
    Random random(14);
    for (int trial = 0; trial < 20'000; ++trial) {
        const auto [first, second] = random_pair(random);
        const auto scaled = [](const Disc& disc) {
            return Disc{disc.x * 0x1p-20, disc.y * 0x1p-20, disc.vx * 0x1p13, disc.vy * 0x1p13};
        };
        Disc one = first;
        Disc two = second;
        Disc scaled_one = scaled(first);
        Disc scaled_two = scaled(second);
        ASSERT_EQ(resolve_pair(scaled_one, scaled_two, relative), resolve_pair(one, two, relative));
        ASSERT_TRUE(same_bits(scaled_one, scaled(one)));
        ASSERT_TRUE(same_bits(scaled_two, scaled(two)));
    }
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

TEST(ResolvePair, StaysExactWhereCentresNearlyCoincide) {
    Disc first{0, 0, 1, 2};
    Disc second{1e-100, 0, -3, 5};
    EXPECT_TRUE(resolve_pair(first, second, relative));
    EXPECT_DOUBLE_EQ(first.vx, -3);
    EXPECT_DOUBLE_EQ(second.vx, 1);
    EXPECT_EQ(first.vy, 2);
    EXPECT_EQ(second.vy, 5);
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
