#include "harness/scenes/changed_scenes.hpp"

#include <algorithm>
#include <utility>

namespace carom {

Scene scaled(Scene scene, double factor) {
    scene.side *= factor;
    scene.radius *= factor;
    for (Disc& disc : scene.discs) {
        disc = {disc.x * factor, disc.y * factor, disc.vx * factor, disc.vy * factor};
    }
    return scene;
}

Scene renumbered(Scene scene) {
    std::ranges::reverse(scene.discs);
    return scene;
}

Scene mirrored(Scene scene) {
    for (Disc& disc : scene.discs) {
        std::swap(disc.x, disc.y);
        std::swap(disc.vx, disc.vy);
    }
    return scene;
}

Scene rotated(Scene scene) {
    for (Disc& disc : scene.discs) {
        disc = {scene.side - disc.y, disc.x, -disc.vy, disc.vx};
    }
    return scene;
}

Scene turned_back(Scene scene) {
    for (Disc& disc : scene.discs) {
        disc.vx = -disc.vx;
        disc.vy = -disc.vy;
    }
    return scene;
}

} // namespace carom
