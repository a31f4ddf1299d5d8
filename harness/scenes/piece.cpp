#include "harness/scenes/piece.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
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

struct Crowd {
    std::size_t discs = 0;
    double cubes = 0; ///< of their speeds, the sum

    double business() const { return static_cast<double>(discs) * cubes; }
};

/// The discs of each window.
std::vector<Crowd> crowds(const Scene& scene, const Windows& windows) {
    std::vector<Crowd> found(windows.per_side * windows.per_side);
    for (const Disc& disc : scene.discs) {
        Crowd& crowd = found[windows.of(disc)];
        ++crowd.discs;
        crowd.cubes += std::pow(std::hypot(disc.vx, disc.vy), 3);
    }
    return found;
}

/// The business of a disc of the scene, on average, over that of a disc of the busiest window.
double whole_over(const Crowd& busiest, const std::vector<Crowd>& all, std::size_t discs) {
    const double in_all = std::accumulate(
        all.begin(), all.end(), 0.0, [](double sum, const Crowd& crowd) { return sum + crowd.business(); });
    const double of_busiest = busiest.cubes * static_cast<double>(discs);
    return of_busiest > 0 ? in_all / of_busiest : 1;
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

Piece busiest_piece(const Scene& scene, std::size_t most_discs) {
    if (scene.discs.size() <= most_discs) {
        return {.scene = scene};
    }
    const double share = static_cast<double>(scene.discs.size()) / static_cast<double>(most_discs);
    for (auto per_side = static_cast<std::size_t>(std::ceil(std::sqrt(share)));;
         per_side += 1 + per_side / 4) {
        const Windows windows(scene, per_side);
        const auto found = crowds(scene, windows);
        const std::size_t most_found = std::ranges::max(found, {}, &Crowd::discs).discs;
        if (most_found <= most_discs || windows.side < 16 * scene.radius) {
            const auto busiest = std::ranges::max_element(
                found, {}, [](const Crowd& crowd) { return std::pair(crowd.business(), crowd.discs); });
            return {.scene = cut(scene, windows, static_cast<std::size_t>(busiest - found.begin())),
                    .whole_over_piece = whole_over(*busiest, found, scene.discs.size())};
        }
    }
}

} // namespace carom
