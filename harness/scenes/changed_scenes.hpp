#pragma once

#include "kernels/scene.hpp"

namespace carom {

/// Changes of a scene that its physics does not notice: what happens next is the same, changed likewise.

/// All lengths and all velocities times `factor`.
Scene scaled(Scene scene, double factor);

/// The discs in the opposite order.
Scene renumbered(Scene scene);

/// Mirrored at the box's diagonal, x and y exchanged: no coordinate is rounded.
Scene mirrored(Scene scene);

/// A quarter turn about the box's middle, (x, y) to (L - y, x).
Scene rotated(Scene scene);

/// All velocities reversed.
Scene turned_back(Scene scene);

} // namespace carom
