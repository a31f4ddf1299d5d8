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
        EventDriven<double> reference(lattice_scene(32, area_fraction, 21));
        const double start = twice_energy(reference.discs());
        for (double time = 10; reference.pair_collisions() < 1'000'000; time += 10) {
            ASSERT_TRUE(reference.advance(time));
        }
        EXPECT_NEAR(twice_energy(reference.discs()) / start, 1, 1e-12) << area_fraction;
    }
}

} // namespace
} // namespace carom::tests
