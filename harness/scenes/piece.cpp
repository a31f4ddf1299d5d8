#include "harness/scenes/piece.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace carom {
namespace {

/// The box divided into equal square windows.
struct Windows {
    double side;
    std::size_t per_side;

    Windows(const Scene& scene, std::size_t windows_per_side)
        : side(scene.side / static_cast<double>(windows_per_side)), per_side(windows_per_side) {}

    std::size_t along(double position) const {
        const double last = static_cast<double>(per_side - 1);
        return static_cast<std::size_t>(std::clamp(std::floor(position / side), 0.0, last));
    }

    std::size_t of(const Disc& disc) const { return along(disc.y) * per_side + along(disc.x); }
};

/// How many discs each window has.
std::vector<std::size_t> counts(const Scene& scene, const Windows& windows) {
    std::vector<std::size_t> found(windows.per_side * windows.per_side);
    for (const Disc& disc : scene.discs) {
        ++found[windows.of(disc)];
    }
    return found;
}

Scene cut(const Scene& scene, const Windows& windows, std::size_t window) {
    const double left = windows.side * static_cast<double>(window % windows.per_side);
    const double low = windows.side * static_cast<double>(window / windows.per_side);
    Scene piece{.side = windows.side, .radius = scene.radius, .steps = scene.steps, .discs = {}};
    const auto fits = [&](double position) {
        return position >= scene.radius && position <= windows.side - scene.radius;
    };
    for (Disc disc : scene.discs) {
        disc.x -= left;
        disc.y -= low;
        if (fits(disc.x) && fits(disc.y)) {
            piece.discs.push_back(disc);
        }
    }
    return piece;
}

} // namespace

Scene fullest_piece(const Scene& scene, std::size_t most_discs) {
    if (scene.discs.size() <= most_discs) {
        return scene;
    }
    const double share = static_cast<double>(scene.discs.size()) / static_cast<double>(most_discs);
    for (auto per_side = static_cast<std::size_t>(std::ceil(std::sqrt(share)));;
         per_side += 1 + per_side / 4) {
        const Windows windows(scene, per_side);
        const auto found = counts(scene, windows);
        const auto fullest = std::ranges::max_element(found);
        if (*fullest <= most_discs || windows.side < 16 * scene.radius) {
            return cut(scene, windows, static_cast<std::size_t>(fullest - found.begin()));
        }
    }
}

} // namespace carom
