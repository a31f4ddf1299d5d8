#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/grid.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom::tests {

struct Box {
    double side;
    double radius;
};

/// A box of up to 30 grid boxes along a side, at any scale that a scene may have.
inline Box random_box(Random& random) {
    const double radius = random.coin() ? random.magnitude(-60, 57) : random.magnitude(-2, 2);
    const double side = std::max(2 * radius, (4 * radius + 1) * random.uniform(0.1, 30));
    return {side, radius};
}

inline Rest random_rest(Random& random) { return random.coin() ? Rest::own_box : Rest::in_last_box; }

inline double some_ulps_from(double value, Random& random) {
    const double ulp =
        std::nextafter(std::abs(value), std::numeric_limits<double>::infinity()) - std::abs(value);
    return value + random.below(9) * ulp - 4 * ulp;
}

/// A position anywhere in the box, at the edge of a grid box or in its middle, at a wall, or outside, near
/// and far.
inline double random_position(const Box& box, const Grid& grid, Random& random) {
    switch (random.below(6)) {
    case 0:
        return some_ulps_from(0.5 * random.below(2 * grid.boxes_per_side() + 1) * grid.box_side(), random);
    case 1:
        return some_ulps_from(random.coin() ? box.radius : box.side - box.radius, random);
    case 2:
        return random.uniform(-3, 3) * box.radius + (random.coin() ? box.side : 0);
    case 3:
        return (random.coin() ? 1 : -1) * random.magnitude(-60, 60);
    default:
        return random.uniform(0, box.side);
    }
}

} // namespace carom::tests
