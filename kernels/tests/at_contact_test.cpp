#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "kernels/at_contact.hpp"

namespace carom {
namespace {

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

} // namespace
} // namespace carom
