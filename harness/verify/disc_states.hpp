#pragma once

#include <cmath>
#include <string>

#include "harness/support/format.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// The second of two discs as the first one sees it: where it is, and how it moves.
template <class Real> BasicDisc<Real> seen_from(const BasicDisc<Real>& first, const BasicDisc<Real>& second) {
    return {second.x - first.x, second.y - first.y, second.vx - first.vx, second.vy - first.vy};
}

template <class Real> Real distance_of(const BasicDisc<Real>& seen) { return std::hypot(seen.x, seen.y); }

template <class Real> Real speed_of(const BasicDisc<Real>& disc) { return std::hypot(disc.vx, disc.vy); }

/// The distance times the speed at which it grows: below 0 while they approach.
template <class Real> Real parting_of(const BasicDisc<Real>& seen) {
    return seen.x * seen.vx + seen.y * seen.vy;
}

/// "(1, 2), velocity (0.5, 0)", so that it reads back as the same numbers.
template <class Real> std::string state_text(const BasicDisc<Real>& disc) {
    return format("(%.17g, %.17g), velocity (%.17g, %.17g)", static_cast<double>(disc.x),
                  static_cast<double>(disc.y), static_cast<double>(disc.vx), static_cast<double>(disc.vy));
}

} // namespace carom
