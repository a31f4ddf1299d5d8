#pragma once

#include <algorithm>
#include <utility>

#include "kernels/scene.hpp"

namespace carom {

/// Changes of a scene that its physics does not notice: what happens next is the same, changed likewise.

/// The scene with each of its discs changed by a function.
template <class Change> Scene with_each_disc(Scene scene, const Change& change) {
    std::ranges::transform(scene.discs, scene.discs.begin(), change);
    return scene;
}

/// All lengths and all velocities times `factor`.
inline Scene scaled(Scene scene, double factor) {
    scene.side *= factor;
    scene.radius *= factor;
    return with_each_disc(std::move(scene), [factor](const Disc& disc) {
        return Disc{disc.x * factor, disc.y * factor, disc.vx * factor, disc.vy * factor};
    });
}

/// The discs in the opposite order.
inline Scene renumbered(Scene scene) {
    std::ranges::reverse(scene.discs);
    return scene;
}

/// Mirrored at the box's diagonal, x and y exchanged: no coordinate is rounded.
inline Scene mirrored(Scene scene) {
    return with_each_disc(std::move(scene),
                          [](const Disc& disc) { return Disc{disc.y, disc.x, disc.vy, disc.vx}; });
}

/// A quarter turn about the box's middle, (x, y) to (L - y, x).
inline Scene rotated(Scene scene) {
    const double side = scene.side;
    return with_each_disc(std::move(scene), [side](const Disc& disc) {
        return Disc{side - disc.y, disc.x, -disc.vy, disc.vx};
    });
}

/// All velocities reversed.
inline Scene turned_back(Scene scene) {
    return with_each_disc(std::move(scene),
                          [](const Disc& disc) { return Disc{disc.x, disc.y, -disc.vx, -disc.vy}; });
}

} // namespace carom
