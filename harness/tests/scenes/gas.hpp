#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "harness/scenes/generate.hpp"

namespace carom::tests {

/// Discs of radius 1 that are apart and fly in all directions, with speeds from `slowest` to `fastest`:
/// placed at random where they are few, and on a lattice where they are many.
inline Scene gas(int count, double side, int steps, double slowest, double fastest, std::uint64_t seed) {
    const bool are_few = count * std::numbers::pi < 0.41 * side * side;
    return generate({.count = count,
                     .side = side,
                     .radius = 1,
                     .steps = steps,
                     .least_velocity = slowest,
                     .largest_velocity = fastest,
                     .seed = seed,
                     .placement = are_few ? Placement::random : Placement::lattice,
                     .isotropic = true});
}

/// The side of a box of which so many of them fill this share.
inline double side_of(int count, double area_fraction) {
    return std::sqrt(count * std::numbers::pi / area_fraction);
}

} // namespace carom::tests
