#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/at_contact.hpp"
#include "kernels/exact/event_driven.hpp"

namespace carom {
namespace {

constexpr double reach = 2;
constexpr WayBack<double> way_back{.step = 1, .all = 2};

double distance(const Disc& one, const Disc& two, double time_ago) {
    return std::hypot(two.x - one.x - (two.vx - one.vx) * time_ago,
                      two.y - one.y - (two.vy - one.vy) * time_ago);
}

/// The latest time, at most `limit` ago, at which the two were apart and, right after, no longer; -1 if there
/// is none. Step by step, from the past.
double contact_by_sampling(const Disc& one, const Disc& two, double limit) {
    constexpr int samples = 20'000;
    for (int k = samples; k > 0; --k) {
        const double before = limit * k / samples;
        const double after = limit * (k - 1) / samples;
        if (distance(one, two, before) > reach && distance(one, two, after) <= reach) {
            return after;
        }
    }
    return -1;
}

TEST(RelativeMotion, FindsTheContactThatSamplingFinds) {
    std::mt19937_64 random(19);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int met = 0;
    int met_and_parted = 0;
    for (int k = 0; k < 600; ++k) {
        const Disc one{5, 5, uniform(random), uniform(random)};
        const Disc two{5 + 2.5 * uniform(random), 5 + 2.5 * uniform(random), 2 * uniform(random),
                       2 * uniform(random)};
        const auto motion = motion_of(one, two, reach * reach);
        const double limit = motion.b < 0 ? way_back.all : way_back.step;
        const double sampled = contact_by_sampling(one, two, limit);
        if (motion.met(way_back)) {
            ++met;
            met_and_parted += motion.c > 0;
            const double time = motion.time_since_contact();
            EXPECT_NEAR(distance(one, two, time), reach, 1e-12);
            // A pair that meets for less than a sample's time is not sampled.
            if (sampled >= 0) {
                EXPECT_NEAR(time, sampled, 2 * limit / 20'000);
            }
        } else {
            EXPECT_LT(sampled, 0) << k;
        }
    }
    EXPECT_GT(met, 100);
    EXPECT_GT(met_and_parted, 3);
}

TEST(RelativeMotion, KnowsNoContactOfDiscsThatMoveAlike) {
    const Disc one{5, 5, 0.5, 0.5};
    EXPECT_FALSE(motion_of(one, {6, 5, 0.5, 0.5}, reach * reach).met(way_back));
    EXPECT_FALSE(motion_of(one, {7, 5, 0.5, 0.5}, reach * reach).met(way_back));
    EXPECT_FALSE(motion_of(one, {5, 5, 0.5, 0.5}, reach * reach).met(way_back));
}

TEST(RelativeMotion, OfTwoPairsAtOnceIsThatOfEach) {
    std::mt19937_64 random(20);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Disc> discs(400);
    for (Disc& disc : discs) {
        disc = {2 * uniform(random), 2 * uniform(random), uniform(random), uniform(random)};
    }
    int met = 0;
    for (int i = 0; i + 3 < static_cast<int>(discs.size()); ++i) {
        const std::array<OverlappingDiscs, 2> pairs{{{i, i + 1}, {i + 3, i + 2}}};
        const auto both = motions_of_two(pairs, discs.data(), reach * reach);
        const auto have_met = both.met(way_back);
        for (std::size_t n = 0; n < 2; ++n) {
            const auto one = motion_of(discs[static_cast<std::size_t>(pairs[n].first)],
                                       discs[static_cast<std::size_t>(pairs[n].second)], reach * reach);
            EXPECT_EQ(both.a[n], one.a);
            EXPECT_EQ(both.b[n], one.b);
            EXPECT_EQ(both.c[n], one.c);
            EXPECT_EQ(have_met[n] != 0, one.met(way_back) != 0);
            met += one.met(way_back);
        }
    }
    EXPECT_GT(met, 40);
    EXPECT_LT(met, 760);
}

TEST(CollideBack, EndsWhereTheReferenceDoes) {
    const Scene scene{
        .side = 50, .radius = 1, .steps = 1, .discs = {{20, 20, 0.75, 0.25}, {22, 21, -0.75, 0}}};
    EventDriven<double> reference(scene);
    ASSERT_TRUE(reference.advance(1));
    ASSERT_EQ(reference.pair_collisions(), 1);
    Disc one{20.75, 20.25, 0.75, 0.25};
    Disc two{21.25, 21, -0.75, 0};
    const auto motion = motion_of(one, two, reach * reach);
    ASSERT_TRUE(motion.met(way_back));
    ASSERT_TRUE(
        collide_back(motion.time_since_contact(), one, two, ApproachTolerance<double>(Tolerance::relative)));
    for (const auto& [found, expected] :
         {std::pair{one, reference.discs()[0]}, {two, reference.discs()[1]}}) {
        EXPECT_NEAR(found.x, expected.x, 1e-14);
        EXPECT_NEAR(found.y, expected.y, 1e-14);
        EXPECT_NEAR(found.vx, expected.vx, 1e-14);
        EXPECT_NEAR(found.vy, expected.vy, 1e-14);
    }
}

/// What collisions of discs of this radius add to the energy of the two on average, relative; and by how much
/// that may be off if each is rounded up as often as down.
struct Drift {
    double mean;
    double uncertain;
};

Drift drift_of_energy(double radius) {
    constexpr int collisions = 200'000;
    std::mt19937_64 random(23);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto energy = [](const Disc& one, const Disc& two) {
        using Long = long double;
        return Long{one.vx} * one.vx + Long{one.vy} * one.vy + Long{two.vx} * two.vx + Long{two.vy} * two.vy;
    };
    long double sum = 0;
    long double squares = 0;
    for (int k = 0; k < collisions;) {
        Disc one{0, 0, uniform(random), uniform(random)};
        Disc two{2 * radius * uniform(random), 2 * radius * uniform(random), uniform(random),
                 uniform(random)};
        const auto motion = motion_of(one, two, 4 * radius * radius);
        const long double before = energy(one, two);
        if (motion.c < 0 && collide_back(motion.time_since_contact(), one, two,
                                         ApproachTolerance<double>(Tolerance::relative))) {
            const long double change = energy(one, two) / before - 1;
            sum += change;
            squares += change * change;
            ++k;
        }
    }
    return {static_cast<double>(sum / collisions), static_cast<double>(std::sqrt(squares) / collisions)};
}

/// Also where the squared distance at contact is a power of two, about which rounding has a side that it
/// prefers.
TEST(CollideBack, KeepsTheEnergyOnAverage) {
    for (const double radius : {0.5, 1.0, 1.3, 16.0}) {
        const Drift drift = drift_of_energy(radius);
        EXPECT_LT(std::abs(drift.mean), 4 * drift.uncertain) << radius;
        EXPECT_LT(drift.uncertain, 1e-18) << radius;
    }
}

TEST(TimeInWall, IsThatSinceTheWallWasMet) {
    EXPECT_EQ(time_in_wall(0.5, -1.0, 50.0, 1.0, way_back), 0.5);
    EXPECT_EQ(time_in_wall(49.5, 0.5, 50.0, 1.0, way_back), 1);
    EXPECT_EQ(time_in_wall(1.0, -1.0, 50.0, 1.0, way_back), 0);
    EXPECT_LT(time_in_wall(0.5, 1.0, 50.0, 1.0, way_back), 0) << "moves out";
    EXPECT_LT(time_in_wall(0.5, 0.0, 50.0, 1.0, way_back), 0) << "does not move";
    EXPECT_LT(time_in_wall(1.5, -1.0, 50.0, 1.0, way_back), 0) << "not there yet";
    EXPECT_LT(time_in_wall(-3.0, -1.0, 50.0, 1.0, way_back), 0) << "too far back";
}

TEST(BounceBack, EndsWhereTheReflectedPathEnds) {
    double position = 0.5;
    double velocity = -1;
    bounce_back(position, velocity, 50.0, 1.0);
    EXPECT_EQ(position, 1.5);
    EXPECT_EQ(velocity, 1);
    position = 49.25;
    bounce_back(position, velocity, 50.0, 1.0);
    EXPECT_EQ(position, 48.75);
    EXPECT_EQ(velocity, -1);
}

} // namespace
} // namespace carom
