#pragma once

#include <cstddef>

#include "kernels/scene.hpp"

namespace carom {

/// A piece of a scene, and what it tells of the whole.
struct Piece {
    Scene scene;
    /// The mean square of the errors of all discs, over that of the discs of the piece, by what windows add.
    double whole_over_piece = 1;
};

/// A square piece of a scene with at most so many discs, and nearly so many if discs are everywhere alike: of
/// equal windows side by side the one that adds most to the errors of a step, with walls where it was cut and
/// without the discs that these would cut. The scene itself if it has no more.
///
/// What a window adds is taken to be its discs times the sum of the cubes of their speeds: the faster a disc
/// is and the more there are, the more often it collides, and the farther it is off after a collision, the
/// square of which counts.
Piece busiest_piece(const Scene& scene, std::size_t most_discs);

} // namespace carom
