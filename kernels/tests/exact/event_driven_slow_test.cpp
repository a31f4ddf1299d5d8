#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/exact/event_driven.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom::tests {
namespace {

double twice_energy(const std::vector<Disc>& discs) {
    double sum = 0;
    for (const auto& disc : discs) {
        sum += disc.vx * disc.vx + disc.vy * disc.vy;
    }
    return sum;
}

/// Each collision rounds the energy of its pair, a thousandth of the scene's, by a few times 1e-16 in either
/// direction: a million of them, added at random, by some 1e-16 of the whole, and never by more than 1e-12.
TEST(EventDrivenForLong, KeepsEnergyTo1em12OverAMillionCollisions) {
    for (const double area_fraction : {0.2, 0.6}) {
        constexpr int per_side = 32;
        const double side = per_side * std::sqrt(std::numbers::pi / area_fraction);
        Random random(21);
        Scene scene{.side = side, .radius = 1, .steps = 0, .discs = {}};
        for (int i = 0; i < per_side * per_side; ++i) {
            const int row = i / per_side;
            const int column = i % per_side;
            const double vx = random.uniform(-1, 1);
            scene.discs.push_back(
                {side / per_side * (column + 0.5), side / per_side * (row + 0.5), vx, random.uniform(-1, 1)});
        }
        EventDriven<double> reference(scene);
        const double start = twice_energy(reference.discs());
        for (double time = 10; reference.pair_collisions() < 1'000'000; time += 10) {
            ASSERT_TRUE(reference.advance(time));
        }
        EXPECT_NEAR(twice_energy(reference.discs()) / start, 1, 1e-12) << area_fraction;
    }
}

} // namespace
} // namespace carom::tests
