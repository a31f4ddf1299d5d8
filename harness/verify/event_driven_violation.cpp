#include "harness/verify/event_driven_violation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "harness/support/format.hpp"
#include "harness/verify/checker.hpp"
#include "harness/verify/disc_states.hpp"
#include "harness/verify/overlapping_pairs.hpp"

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

/// The straight way of a disc that met nobody, with the box around it.
struct Way {
    std::size_t disc;
    Disc start;
    double low_x;
    double high_x;
    double low_y;
    double high_y;
};

/// The ways of those that met nobody, from left to right.
std::vector<Way> free_ways(const std::vector<Disc>& before, const std::vector<Disc>& after, double dt,
                           const Walls& walls, double slack) {
    std::vector<Way> ways;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Disc& from = before[i];
        const Disc& to = after[i];
        const bool straight = to.vx == from.vx && to.vy == from.vy &&
                              std::hypot(from.x + from.vx * dt - to.x, from.y + from.vy * dt - to.y) <= slack;
        if (straight) {
            ways.push_back({.disc = i,
                            .start = from,
                            .low_x = std::min(from.x, to.x) - walls.radius,
                            .high_x = std::max(from.x, to.x) + walls.radius,
                            .low_y = std::min(from.y, to.y) - walls.radius,
                            .high_y = std::max(from.y, to.y) + walls.radius});
        }
    }
    std::ranges::sort(ways, {}, &Way::low_x);
    return ways;
}

double least_distance(const Disc& one, const Disc& two, double dt) {
    const Disc d = seen_from(one, two);
    const double squared = d.vx * d.vx + d.vy * d.vy;
    const double nearest = squared > 0 ? std::clamp(-parting_of(d) / squared, 0.0, dt) : 0;
    return std::hypot(d.x + d.vx * nearest, d.y + d.vy * nearest);
}

/// Two that met nobody although their ways cross.
std::optional<std::string> missed_collision(const std::vector<Way>& ways, double dt, const Walls& walls,
                                            double slack) {
    for (auto one = ways.begin(); one != ways.end(); ++one) {
        for (auto two = one + 1; two != ways.end() && two->low_x <= one->high_x; ++two) {
            if (two->low_y > one->high_y || two->high_y < one->low_y) {
                continue;
            }
            const double depth = 2 * walls.radius - least_distance(one->start, two->start, dt);
            if (depth > slack) {
                return format("discs %zu and %zu flew through each other, %.3g deep",
                              std::min(one->disc, two->disc), std::max(one->disc, two->disc), depth);
            }
        }
    }
    return std::nullopt;
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
    return missed_collision(free_ways(before, after, dt, walls, slack), dt, walls, slack);
}

std::optional<std::string> overlap_at_start(const Scene& scene) {
    const Walls walls{.side = scene.side, .radius = scene.radius, .rounding = Rounding()};
    return overlap(scene.discs, walls, allowed(scene.discs, 0, walls));
}

} // namespace carom
