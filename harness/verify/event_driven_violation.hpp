#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/verify/walls.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// What an event-driven simulation did wrong between two states that are `dt` apart, or nothing. With
/// everything to some roundings of the scene's numbers:
///  - All states are finite, no two discs overlap and no disc overlaps a wall.
///  - All discs together keep their energy.
///  - Discs that met nobody, with the velocity and at the place of their free flight, came near each other or
///    a wall nowhere on their ways.
std::optional<std::string> event_driven_violation(const std::vector<Disc>& before,
                                                  const std::vector<Disc>& after, double dt,
                                                  const Walls& walls);

/// The first two discs, or the first disc and a wall, that overlap at the start, or nothing: what the
/// event-driven simulation cannot begin with. Discs that touch do not overlap.
std::optional<std::string> overlap_at_start(const Scene& scene);

} // namespace carom
