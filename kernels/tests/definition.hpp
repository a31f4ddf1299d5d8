#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/scene.hpp"

namespace carom::tests {

/// Does any pair or wall collide, by the definition?
inline bool anything_collides(const Scene& scene, const std::vector<Disc>& discs) {
    const auto into_wall = [&scene](double x, double vx) {
        return (x - scene.radius <= 0 && vx < 0) || (x + scene.radius >= scene.side && vx > 0);
    };
    for (const Disc& one : discs) {
        if (into_wall(one.x, one.vx) || into_wall(one.y, one.vy)) {
            return true;
        }
        for (const Disc& two : discs) {
            const double dx = two.x - one.x;
            const double dy = two.y - one.y;
            const double approach = (two.vx - one.vx) * dx + (two.vy - one.vy) * dy;
            if (dx * dx + dy * dy > 4 * scene.radius * scene.radius || approach >= 0) {
                continue;
            }
            const double speeds = std::hypot(std::hypot(one.vx, one.vy), std::hypot(two.vx, two.vy));
            if (approach < -1e-13 * std::hypot(dx, dy) * speeds) {
                return true;
            }
        }
    }
    return false;
}

inline double energy_of(const std::vector<Disc>& discs) {
    double energy = 0;
    for (const Disc& disc : discs) {
        energy += disc.vx * disc.vx + disc.vy * disc.vy;
    }
    return energy;
}

/// Steps a simulation through a scene; after each step the definition of a step must hold. `discs_now()`
/// gives the discs by number.
template <class Discs, class Step>
void keeps_to_the_definition(const Scene& scene, const Discs& discs_now, const Step& step) {
    for (int k = 0; k < scene.steps; ++k) {
        const std::vector<Disc> before = discs_now();
        ASSERT_TRUE(step().settled);
        const std::vector<Disc> discs = discs_now();
        for (std::size_t i = 0; i < discs.size(); ++i) {
            ASSERT_EQ(discs[i].x, before[i].x + before[i].vx);
            ASSERT_EQ(discs[i].y, before[i].y + before[i].vy);
        }
        ASSERT_FALSE(anything_collides(scene, discs)) << "after step " << k + 1;
        ASSERT_NEAR(energy_of(discs), energy_of(before), 1e-11 * energy_of(before)) << "in step " << k + 1;
    }
}

} // namespace carom::tests
