#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/verify/overlapping_pairs.hpp"
#include "harness/verify/walls.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// How far from its radius a disc is looked for at the end of a step, in radii (Impact::at_contact): an
/// eighth at most.
inline constexpr double widest_look = 1.125;

/// Every disc at the end of a free flight of `dt`, in the precision of the walls.
std::vector<Disc> flown(const std::vector<Disc>& before, double dt, const Walls& walls);

/// The walls as discs meet them that are looked for so far from them.
Walls widened(const Walls& walls);

/// The pairs whose collisions may have touched both discs: near each other after their free flight and both
/// touched, or overlapping there, since one may have taken up a blow and passed all of it on.
std::vector<OverlappingPair> colliding_pairs(const std::vector<Disc>& free, const std::vector<Disc>& after,
                                             const Walls& walls);

/// What a step with Impact::at_contact did wrong, or nothing, but for what it left colliding. `free` are the
/// discs at the end of their free flight. Discs that are not where it ended, or not as fast, have been
/// touched: nobody else was.
///  - A disc touched was near another one that was, or near a wall, or overlapped one that took up a blow and
///    passed all of it on.
///  - Groups of them keep their energy and, away from walls, their momentum, the path of their centre of mass
///    and their angular momentum: all of these are kept by collisions along the line of centres at the moment
///    of contact, with free flight before and after.
///  - A pair that met in this step, with nothing else near, ends where the two-body problem says: followed
///    forward from the start of the step, to rounding. Where rounding decides whether it met in this step or
///    meets in the next one, both are right.
///  - A disc that met a wall in this step, and no other disc, ends where the reflected path ends.
std::optional<std::string> at_contact_violation(const std::vector<Disc>& before,
                                                const std::vector<Disc>& free, const std::vector<Disc>& after,
                                                double dt, const Walls& walls);

} // namespace carom
