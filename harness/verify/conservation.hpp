#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/verify/overlapping_pairs.hpp"
#include "harness/verify/walls.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// The first thing that collisions failed to conserve, or nothing. `free` are the discs after their free
/// flight, before any collision; `pairs` are those that may have collided. Energy is to be kept by each
/// connected group of them; momentum, the centre of mass and angular momentum by those that no wall touches;
/// and a disc of no group keeps its velocity, but for the sign of a component that a wall turned. Relative to
/// 1e-10 in double, where rounding leaves some 1e-16 a resolve, and to 1e-4 in float, where it leaves some
/// 1e-7; where discs were moved, to 64 roundings of their positions, and where Impact::at_contact may have
/// moved a disc by less than a rounding, to one.
std::optional<std::string> conservation_violation(const std::vector<Disc>& free,
                                                  const std::vector<Disc>& after,
                                                  const std::vector<OverlappingPair>& pairs,
                                                  const Walls& walls, Impact impact);

} // namespace carom
