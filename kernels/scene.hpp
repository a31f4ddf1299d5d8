#pragma once

#include <cstddef>
#include <numbers>
#include <vector>

namespace carom {

/// One disc. Positions are of its centre, in units of length; velocities in units of length per unit of time.
/// Aligned so that no disc lies across two cache lines.
template <class Real> struct alignas(4 * sizeof(Real)) BasicDisc {
    Real x = 0;
    Real y = 0;
    Real vx = 0;
    Real vy = 0;

    friend bool operator==(const BasicDisc&, const BasicDisc&) = default;
};

using Disc = BasicDisc<double>;

template <class To, class From> BasicDisc<To> disc_cast(const BasicDisc<From>& disc) {
    return {static_cast<To>(disc.x), static_cast<To>(disc.y), static_cast<To>(disc.vx),
            static_cast<To>(disc.vy)};
}

/// The initial conditions: equal discs of unit mass in a square box with a corner at the origin.
struct Scene {
    double side = 0;         ///< L, length of the box's side
    double radius = 0;       ///< r, of every disc
    int steps = 0;           ///< S, units of time to simulate
    std::vector<Disc> discs; ///< disc i stands at index i; any position, overlapping or outside, is allowed
};

/// The share of the box's area that the discs' areas add up to, N pi r^2 / L^2 (overlaps counted twice).
inline double area_fraction(const Scene& scene) {
    return static_cast<double>(scene.discs.size()) * std::numbers::pi * scene.radius * scene.radius /
           (scene.side * scene.side);
}

} // namespace carom
