#pragma once

#include <cmath>
#include <string>

#include "harness/support/format.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// The second of two discs as the first one sees it: where it is, and how it moves.
inline Disc seen_from(const Disc& first, const Disc& second) {
    return {second.x - first.x, second.y - first.y, second.vx - first.vx, second.vy - first.vy};
}

inline double distance_of(const Disc& seen) { return std::hypot(seen.x, seen.y); }

inline double speed_of(const Disc& disc) { return std::hypot(disc.vx, disc.vy); }

/// The distance times the speed at which it grows: below 0 while they approach.
inline double parting_of(const Disc& seen) { return seen.x * seen.vx + seen.y * seen.vy; }

/// "(1, 2), velocity (0.5, 0)", so that it reads back as the same numbers.
inline std::string state_text(const Disc& disc) {
    return format("(%.17g, %.17g), velocity (%.17g, %.17g)", disc.x, disc.y, disc.vx, disc.vy);
}

} // namespace carom
