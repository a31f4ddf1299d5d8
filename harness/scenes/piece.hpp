#pragma once

#include <cstddef>

#include "kernels/scene.hpp"

namespace carom {

/// A square piece of a scene with at most so many discs, and nearly so many if discs are everywhere alike: of
/// equal windows side by side the fullest, with walls where it was cut and without the discs that these would
/// cut. The scene itself if it has no more.
Scene fullest_piece(const Scene& scene, std::size_t most_discs);

} // namespace carom
