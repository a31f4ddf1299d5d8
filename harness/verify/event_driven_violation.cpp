#include "harness/verify/event_driven_violation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "harness/support/format.hpp"
#include "harness/verify/checker.hpp"
#include "harness/verify/disc_states.hpp"
#include "harness/verify/overlapping_pairs.hpp"
#include "harness/verify/path_search.hpp"

namespace carom {
namespace {

/// Of the numbers that places and times are computed from.
constexpr double roundings = 256;

/// How far a place may be off.
double allowed(const std::vector<Disc>& discs, double dt, const Walls& walls) {
    double extent = walls.side + walls.radius;
    for (const Disc& disc : discs) {
        extent = std::max(extent, std::max(std::abs(disc.x), std::abs(disc.y)) +
                                      std::max(std::abs(disc.vx), std::abs(disc.vy)) * dt);
    }
    return roundings * walls.rounding.epsilon() * extent;
}

std::optional<std::string> overlap(const std::vector<Disc>& discs, const Walls& walls, double slack) {
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const double low = std::min(discs[i].x, discs[i].y) - walls.radius;
        const double high = std::max(discs[i].x, discs[i].y) + walls.radius;
        if (low < -slack || high > walls.side + slack) {
            return format("disc %zu overlaps a wall by %.3g", i, std::max(-low, high - walls.side));
        }
    }
    for (const OverlappingPair& pair : overlapping_pairs(discs, walls.radius, walls.rounding)) {
        const Disc& one = discs[static_cast<std::size_t>(pair.first)];
        const Disc& two = discs[static_cast<std::size_t>(pair.second)];
        const double depth = 2 * walls.radius - distance_of(seen_from(one, two));
        if (depth > slack) {
            return format("discs %d and %d overlap by %.3g", pair.first, pair.second, depth);
        }
    }
    return std::nullopt;
}

/// The paths of those that met nobody.
std::vector<PathPiece> free_paths(const std::vector<Disc>& before, const std::vector<Disc>& after, double dt,
                                  double slack) {
    std::vector<PathPiece> paths;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Path path{before[i], 0};
        const Disc end = path.at(dt);
        if (after[i].vx == end.vx && after[i].vy == end.vy &&
            distance_of(seen_from(end, after[i])) <= slack) {
            paths.push_back({i, path, 0, dt});
        }
    }
    return paths;
}

} // namespace

std::optional<std::string> event_driven_violation(const std::vector<Disc>& before,
                                                  const std::vector<Disc>& after, double dt,
                                                  const Walls& walls) {
    for (std::size_t i = 0; i < after.size(); ++i) {
        if (auto violation = not_finite(after[i], i)) {
            return violation;
        }
    }
    const double slack = allowed(before, dt, walls);
    if (auto violation = overlap(after, walls, slack)) {
        return violation;
    }
    const double energy = kinetic_energy(before);
    const double change = kinetic_energy(after) - energy;
    if (std::abs(change) > 1e-10 * energy) {
        return format("energy changed from %.17g to %.17g", energy, energy + change);
    }
    return PathSearch(walls.side, walls.radius, before.size())
        .too_near(free_paths(before, after, dt, slack), 0, dt);
}

std::optional<std::string> overlap_at_start(const Scene& scene) {
    const Walls walls{.side = scene.side, .radius = scene.radius, .rounding = Rounding()};
    return overlap(scene.discs, walls, allowed(scene.discs, 0, walls));
}

} // namespace carom
