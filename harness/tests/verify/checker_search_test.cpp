#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "harness/verify/checker.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

/// How many pairs and walls collide, by looking at all pairs.
long brute_force(const Scene& scene) {
    const auto into_wall = [&scene](double x, double vx) {
        return (x - scene.radius <= 0 && vx < 0) || (x + scene.radius >= scene.side && vx > 0);
    };
    long count = 0;
    for (std::size_t i = 0; i < scene.discs.size(); ++i) {
        const Disc& one = scene.discs[i];
        count += into_wall(one.x, one.vx) || into_wall(one.y, one.vy);
        for (std::size_t j = 0; j < i; ++j) {
            const Disc& two = scene.discs[j];
            const double dx = two.x - one.x;
            const double dy = two.y - one.y;
            const double approach = (two.vx - one.vx) * dx + (two.vy - one.vy) * dy;
            const double speeds = std::hypot(std::hypot(one.vx, one.vy), std::hypot(two.vx, two.vy));
            count += dx * dx + dy * dy <= 4 * scene.radius * scene.radius &&
                     approach < -1e-13 * std::hypot(dx, dy) * speeds;
        }
    }
    return count;
}

long checkers_count(const Scene& scene) {
    return Checker(scene.side, scene.radius, 1, Tolerance::relative).count_colliding(scene.discs);
}

void expect_all_found(const Scene& scene) {
    const long expected = brute_force(scene);
    EXPECT_EQ(checkers_count(scene), expected);
    EXPECT_EQ(Checker(scene.side, scene.radius, 1, Tolerance::relative).colliding(scene.discs).has_value(),
              expected > 0);
}

TEST(CheckersSearch, FindsWhatLookingAtAllPairsFinds) {
    for (const auto& [name, scene] : tests::all_scenes()) {
        SCOPED_TRACE(name);
        expect_all_found(scene);
    }
    EXPECT_GT(brute_force(tests::random_scene_of_density(300, 0.9, 1, 4)), 50);
}

TEST(CheckersSearch, FindsPairsAtEveryScaleAndAnyDistanceFromTheOrigin) {
    tests::Random random(101);
    for (int trial = 0; trial < 300; ++trial) {
        const double radius = random.magnitude(-60, 50);
        const double offset = (random.coin() ? 1 : -1) * radius * random.magnitude(0, 20);
        Scene scene{.side = 100 * radius, .radius = radius, .steps = 1, .discs = {}};
        for (int i = 0; i < 60; ++i) {
            const double x = offset + random.uniform(-10, 10) * radius;
            const double y = -offset + random.uniform(-10, 10) * radius;
            const double vx = random.uniform(-1, 1);
            scene.discs.push_back({x, y, vx, random.uniform(-1, 1)});
        }
        SCOPED_TRACE(testing::Message() << "r = " << radius << ", around " << offset);
        expect_all_found(scene);
    }
}

TEST(CheckersSearch, FindsAPairThatJustTouchesWhereverItIs) {
    // One disc straight above the other at exactly 2r, at heights where the checker's strips begin and end.
    const double radius = 0.5;
    for (int exponent = 0; exponent < 50; ++exponent) {
        for (int ulps = -40; ulps <= 40; ++ulps) {
            const double power = std::ldexp(1.0, exponent) * (1 + 1e-9);
            const double y = power - 1 + ulps * std::ldexp(1.0, exponent - 53);
            if (y + 1 - y != 1) {
                continue;
            }
            const Scene scene{
                .side = 1e60, .radius = radius, .steps = 1, .discs = {{9, y, 0, 1}, {9, y + 1, 0, 0}}};
            EXPECT_EQ(checkers_count(scene), brute_force(scene))
                << "y = 2^" << exponent << ", " << ulps << " ulps off";
        }
    }
}

} // namespace
} // namespace carom
