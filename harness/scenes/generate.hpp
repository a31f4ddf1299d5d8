#pragma once

#include <cstdint>

#include "harness/scenes/placement.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// What the generator is asked for.
struct GeneratorArguments {
    int count = 0;
    double side = 0;
    double radius = 0;
    int steps = 0;
    double least_velocity = 0;   ///< of each component; of the speed if isotropic
    double largest_velocity = 0; ///< of each component; of the speed if isotropic
    std::uint64_t seed = 1;
    Placement placement = Placement::overlapping;
    bool isotropic = false; ///< directions uniform over the circle and speeds uniform in the range
};

/// A random scene, the same on every platform.
///
/// The published way (overlapping, not isotropic): centres uniform in [0, L)^2 and both velocity components
/// uniform in [least, largest], drawn per disc in the order x, y, vx, vy. The other placements draw all
/// centres first, then all velocities. An isotropic velocity is a speed times a point uniform in the unit
/// circle divided by its length. Throws InputError if a placement has no room.
Scene generate(const GeneratorArguments& arguments);

} // namespace carom
