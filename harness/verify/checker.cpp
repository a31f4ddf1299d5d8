#include "harness/verify/checker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/support/format.hpp"
#include "harness/verify/at_contact.hpp"
#include "harness/verify/conservation.hpp"
#include "harness/verify/disc_states.hpp"
#include "harness/verify/event_driven_violation.hpp"

namespace carom {

namespace {

/// Of centres nearer than this nobody asks in which direction they collide: below a hundredth of it |d|^2 has
/// too few bits left, and the kernel takes them for coincident. The hundred covers the rounding of either.
template <class Real>
const double coincident =
    100 * std::sqrt(double{std::numeric_limits<Real>::min()} / double{std::numeric_limits<Real>::epsilon()});

} // namespace

std::optional<std::string> not_finite(const Disc& disc, std::size_t i) {
    if (std::isfinite(disc.x + disc.y + disc.vx + disc.vy)) {
        return std::nullopt;
    }
    return format("disc %zu has a state that is not finite: (%g, %g), velocity (%g, %g)", i, disc.x, disc.y,
                  disc.vx, disc.vy);
}

Checker::Checker(double side, double radius, double dt, Tolerance tolerance, const Rounding& rounding,
                 Impact impact, Engine engine)
    : walls_{.side = rounding(side), .radius = rounding(radius), .rounding = rounding}, dt_(rounding(dt)),
      tolerance_(tolerance), rounding_(rounding), impact_(impact), engine_(engine) {}

std::optional<std::string> Checker::step(const std::vector<Disc>& before,
                                         const std::vector<Disc>& after) const {
    if (before.size() != after.size()) {
        return format("%zu discs became %zu", before.size(), after.size());
    }
    if (engine_ == Engine::event_driven) {
        return event_driven_violation(before, after, dt_, walls_);
    }
    const std::vector<Disc> free = flown(before, dt_, walls_);
    if (auto violation = moved(before, free, after)) {
        return violation;
    }
    const std::vector<OverlappingPair> pairs = overlapping_pairs(after, walls_.radius, rounding_);
    if (auto violation = left_colliding(free, after, pairs)) {
        return violation;
    }
    return impact_ == Impact::at_contact ? at_contact_violation(before, free, after, dt_, walls_)
                                         : conservation_violation(free, after, pairs, walls_, impact_);
}

std::optional<std::string> Checker::left_colliding(const std::vector<Disc>& free,
                                                   const std::vector<Disc>& after,
                                                   const std::vector<OverlappingPair>& pairs) const {
    const auto at = [](const std::vector<Disc>& discs, int i) { return discs[static_cast<std::size_t>(i)]; };
    const auto was_moved = [&](int i) {
        return at(after, i).x != at(free, i).x || at(after, i).y != at(free, i).y;
    };
    for (const OverlappingPair& pair : pairs) {
        const bool moved_together =
            (was_moved(pair.first) || was_moved(pair.second)) &&
            overlapping_pairs({at(free, pair.first), at(free, pair.second)}, walls_.radius, rounding_)
                .empty();
        auto violation = moved_together ? std::nullopt : pair_colliding(after, pair);
        if (violation) {
            return violation;
        }
    }
    for (int i = 0; i < static_cast<int>(after.size()); ++i) {
        const bool moved_into_wall =
            was_moved(i) && !walls_.touches(at(free, i).x) && !walls_.touches(at(free, i).y);
        auto violation = moved_into_wall ? std::nullopt : wall_colliding(after, i);
        if (violation) {
            return violation;
        }
    }
    return std::nullopt;
}

/// `body(violation)` for each wall and each pair, which may be nothing.
template <class Body>
void Checker::for_each_colliding(const std::vector<Disc>& discs, const Body& body) const {
    for (int i = 0; i < static_cast<int>(discs.size()); ++i) {
        body(wall_colliding(discs, i));
    }
    for (const OverlappingPair& pair : overlapping_pairs(discs, walls_.radius, rounding_)) {
        body(pair_colliding(discs, pair));
    }
}

std::optional<std::string> Checker::colliding(const std::vector<Disc>& discs) const {
    std::optional<std::string> first;
    for_each_colliding(discs, [&](const auto& violation) { first = first ? first : violation; });
    return first;
}

long Checker::count_colliding(const std::vector<Disc>& discs) const {
    long count = 0;
    for_each_colliding(discs, [&](const auto& violation) { count += violation.has_value(); });
    return count;
}

std::optional<std::string> Checker::moved(const std::vector<Disc>& before, const std::vector<Disc>& free,
                                          const std::vector<Disc>& after) const {
    for (std::size_t i = 0; i < free.size(); ++i) {
        if (impact_ == Impact::step_end && (after[i].x != free[i].x || after[i].y != free[i].y)) {
            return format("disc %zu moved from (%.17g, %.17g) to (%.17g, %.17g) instead of to (%.17g, %.17g)",
                          i, before[i].x, before[i].y, after[i].x, after[i].y, free[i].x, free[i].y);
        }
        if (auto violation = not_finite(after[i], i)) {
            return violation;
        }
    }
    return std::nullopt;
}

std::optional<std::string> Checker::wall_colliding(const std::vector<Disc>& discs, int i) const {
    const Disc& disc = discs[static_cast<std::size_t>(i)];
    const bool into_low =
        (walls_.touches_low(disc.x) && disc.vx < 0) || (walls_.touches_low(disc.y) && disc.vy < 0);
    const bool into_high =
        (walls_.touches_high(disc.x) && disc.vx > 0) || (walls_.touches_high(disc.y) && disc.vy > 0);
    if (!into_low && !into_high) {
        return std::nullopt;
    }
    return format("disc %d at (%.17g, %.17g) is left moving into a wall with velocity (%.17g, %.17g)", i,
                  disc.x, disc.y, disc.vx, disc.vy);
}

std::optional<std::string> Checker::pair_colliding(const std::vector<Disc>& discs,
                                                   const OverlappingPair& pair) const {
    const Disc& one = discs[static_cast<std::size_t>(pair.first)];
    const Disc& two = discs[static_cast<std::size_t>(pair.second)];
    const Disc d = seen_from(one, two);
    const double distance = distance_of(d);
    if (distance < (rounding_.is_double() ? coincident<double> : coincident<float>)) {
        return std::nullopt;
    }
    const double approach = parting_of(d);
    const double speeds = std::hypot(speed_of(one), speed_of(two));
    // Twice what the kernel leaves, since both round.
    const double allowed = std::max(tolerance_ == Tolerance::published ? 1e-7 : 0,
                                    2 * 64 * rounding_.epsilon() * distance * speeds);
    if (approach >= -allowed) {
        return std::nullopt;
    }
    return format("discs %d and %d, %.17g apart, are left approaching at %.17g per unit of time", pair.first,
                  pair.second, distance, -approach / distance);
}

} // namespace carom
