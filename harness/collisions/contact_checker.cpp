#include "harness/collisions/contact_checker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "harness/collisions/exchange.hpp"
#include "harness/support/format.hpp"
#include "harness/verify/at_contact.hpp"
#include "harness/verify/conservation.hpp"

namespace carom {
namespace {

/// As far as a disc of the usual speed, the root of the mean square at the start, flies in a step two may be
/// apart; an eighth of their size at most.
double near_radius(const Scene& scene, double dt) {
    double sum = 0;
    for (const Disc& disc : scene.discs) {
        sum += disc.vx * disc.vx + disc.vy * disc.vy;
    }
    const double speed = std::sqrt(sum / static_cast<double>(std::max(scene.discs.size(), std::size_t{1})));
    return std::min(scene.radius + speed * dt / 2, widest_look * scene.radius);
}

ContactRules rules_of(const Scene& scene, const Policies& policies, const Tuning& tuning) {
    const Rounding rounding = rounding_of(policies);
    const double dt = rounding(1.0 / tuning.substeps);
    return {.walls = {.side = rounding(scene.side), .radius = rounding(scene.radius), .rounding = rounding},
            .dt = dt,
            .way_back = dt,
            .near = near_radius(scene, dt),
            .tolerance = tuning.tolerance};
}

std::string when(const Collision<double>& collision) {
    return format(" (%.17g before the end, sweep %d)", collision.time, collision.sweep);
}

} // namespace

ContactChecker::ContactChecker(const Scene& scene, const Policies& policies, const Tuning& tuning)
    : at_end_(scene.side, scene.radius, 1.0 / tuning.substeps, tuning.tolerance, rounding_of(policies)),
      rules_(rules_of(scene, policies, tuning)) {}

void ContactChecker::collided(const Collision<double>& collision) {
    const std::lock_guard lock(telling_);
    collisions_.push_back(collision);
}

std::optional<std::string> ContactChecker::step(const std::vector<Disc>& before,
                                                const std::vector<Disc>& after) {
    if (before.size() != after.size()) {
        return format("%zu discs became %zu", before.size(), after.size());
    }
    steps_ = std::min(steps_ + 1, 2);
    rules_.way_back = rules_.dt * steps_;
    discs_ = flown(before, rules_.dt, rules_.walls);
    near_.find(discs_, rules_);
    std::ranges::sort(collisions_, [](const auto& one, const auto& two) {
        return std::pair(one.sweep, one.first) < std::pair(two.sweep, two.first);
    });
    Found violation = collide_sweeps();
    collisions_.clear();
    violation = violation ? violation : left_pending();
    return violation ? violation : wrong_after(after);
}

/// All collisions of a sweep are looked at before the first of them is made: what they were chosen by.
std::optional<std::string> ContactChecker::collide_sweeps() {
    sweeps_ = 0;
    std::vector<int> collided_in(discs_.size(), -1);
    const auto takes_part = [&](int i, int sweep) {
        return std::exchange(collided_in[static_cast<std::size_t>(i)], sweep) == sweep;
    };
    for (auto begin = collisions_.begin(); begin != collisions_.end();) {
        const int sweep = begin->sweep;
        const auto end = std::find_if(begin, collisions_.end(),
                                      [sweep](const auto& collision) { return collision.sweep != sweep; });
        for (auto collision = begin; collision != end; ++collision) {
            if (auto violation = violation_of(*collision)) {
                return violation;
            }
            if (takes_part(collision->first, sweep) ||
                (!collision->at_wall() && takes_part(collision->second, sweep))) {
                return format("disc %d or %d collides twice", collision->first, collision->second) +
                       when(*collision);
            }
        }
        for (; begin != end; ++begin) {
            discs_[static_cast<std::size_t>(begin->first)] = begin->first_after;
            discs_[static_cast<std::size_t>(begin->second)] = begin->second_after;
            near_.find_pair(begin->first, begin->second)->last = begin->time;
        }
        sweeps_ = sweep + 1;
    }
    return std::nullopt;
}

std::optional<std::string> ContactChecker::violation_of(const Collision<double>& collision) {
    if (Found violation = unknown_discs(collision, static_cast<int>(discs_.size()))) {
        return violation;
    }
    const DiscsNearby* near = near_.find_pair(collision.first, collision.second);
    if (near == nullptr) {
        return format("discs %d and %d collide, and were not near each other, or a wall", collision.first,
                      collision.second) +
               when(collision);
    }
    if (!(collision.time >= 0 && collision.time < near->last)) {
        return format("discs %d and %d collide %.17g before the end, after %.17g", collision.first,
                      collision.second, collision.time, near->last);
    }
    Found violation = collision.at_wall() ? wrong_wall(collision) : wrong_pair(collision);
    violation = violation ? violation : earlier(collision.first, collision);
    return violation || collision.at_wall() ? violation : earlier(collision.second, collision);
}

std::optional<std::string> ContactChecker::wrong_pair(const Collision<double>& collision) const {
    const PairBackwards pair(rules_, disc(collision.first), disc(collision.second));
    const Disc d = pair.at(collision.time);
    const double distance = distance_of(d);
    const auto who = [&] { return format("discs %d and %d", collision.first, collision.second); };
    if (!(std::abs(distance * distance - pair.reach() * pair.reach()) <= 2 * pair.uncertain())) {
        return who() + format(" collide while they are %.17g apart, not %.17g", distance, pair.reach()) +
               when(collision);
    }
    if (!(collision.time <= pair.way_back() * (1 + 32 * rules_.epsilon()))) {
        return who() + " collide before the way back" + when(collision);
    }
    // A grazing pair may be seen to part a little: by the root of what its distance is uncertain.
    if (!(parting_of(d) <= 2 * speed_of(d) * std::sqrt(pair.uncertain()))) {
        return who() + " collide while they part" + when(collision);
    }
    return wrong_exchange(collision, d, std::sqrt(rules_.epsilon() * pair.uncertain()) / distance);
}

/// `d` is the line of centres, and `uncertain` its direction.
std::optional<std::string> ContactChecker::wrong_exchange(const Collision<double>& collision, const Disc& d,
                                                          double uncertain) const {
    const Disc& one = disc(collision.first);
    const Disc& two = disc(collision.second);
    const double epsilon = rules_.epsilon();
    if (const Found violation = wrong_velocities(collision, one, two, d, epsilon, 8 * uncertain, false)) {
        return *violation + when(collision);
    }
    const double speeds = speed_of(one) + speed_of(two);
    const auto astray = [&](const Disc& before, const Disc& after) {
        const double x = before.x + (after.vx - before.vx) * collision.time;
        const double y = before.y + (after.vy - before.vy) * collision.time;
        const double extent = std::abs(x) + std::abs(y) + std::abs(before.x) + std::abs(before.y);
        return !(std::hypot(after.x - x, after.y - y) <= 16 * epsilon * (extent + speeds * collision.time));
    };
    if (astray(one, collision.first_after) || astray(two, collision.second_after)) {
        return told_velocities(collision, one, two, "are not where they have flown since") + when(collision);
    }
    return std::nullopt;
}

std::optional<std::string> ContactChecker::wrong_wall(const Collision<double>& collision) const {
    const Disc& before = disc(collision.first);
    const Disc& after = collision.first_after;
    const double low = rules_.walls.radius;
    const double high = rules_.walls.side - rules_.walls.radius;
    int turned = 0;
    const auto is_right = [&](double position, double velocity, double new_position, double new_velocity) {
        const bool now = time_in_wall(rules_, position, velocity) == collision.time;
        turned += now;
        const double allowed = 16 * rules_.epsilon() * (std::abs(position) + rules_.walls.side);
        return now ? new_velocity == -velocity &&
                         std::abs(2 * (velocity < 0 ? low : high) - position - new_position) <= allowed
                   : new_velocity == velocity && new_position == position;
    };
    const bool right_in_x = is_right(before.x, before.vx, after.x, after.vx);
    const bool right_in_y = is_right(before.y, before.vy, after.y, after.vy);
    if (right_in_x && right_in_y && turned > 0) {
        return std::nullopt;
    }
    return format("disc %d at %s, is at %s, after a wall that it met", collision.first,
                  state_text(before).c_str(), state_text(after).c_str()) +
           when(collision);
}

/// A collision of a disc that was to be made before this one.
std::optional<std::string> ContactChecker::earlier(int i, const Collision<double>& collision) const {
    for (const std::size_t place : near_.places_of(i)) {
        const DiscsNearby& near = near_.all()[place];
        const auto pending = surely_pending(near);
        if (pending && pending->time - pending->uncertain > collision.time * (1 + 32 * rules_.epsilon())) {
            return format(
                       "discs %d and %d collide before discs %d and %d, which met earlier, %.17g before the "
                       "end",
                       collision.first, collision.second, near.first, near.second, pending->time) +
                   when(collision);
        }
    }
    return std::nullopt;
}

std::optional<PastCollision> ContactChecker::surely_pending(const DiscsNearby& near) const {
    if (!near.surely) {
        return std::nullopt;
    }
    const Disc& one = disc(near.first);
    if (near.at_wall()) {
        const double time =
            std::max(time_in_wall(rules_, one.x, one.vx), time_in_wall(rules_, one.y, one.vy));
        return time >= 0 && time < near.last ? std::optional(PastCollision{time, 0}) : std::nullopt;
    }
    const auto met = PairBackwards(rules_, one, disc(near.second)).surely_met();
    return met && met->time < near.last - met->uncertain ? met : std::nullopt;
}

std::optional<std::string> ContactChecker::left_pending() const {
    if (sweeps_ == most_sweeps_at_contact) {
        return std::nullopt;
    }
    for (const DiscsNearby& near : near_.all()) {
        if (const auto pending = surely_pending(near)) {
            return format(
                "discs %d and %d met %.17g before the end, and do not collide although %d sweeps were "
                "left",
                near.first, near.second, pending->time, most_sweeps_at_contact - sweeps_);
        }
    }
    return std::nullopt;
}

std::optional<std::string> ContactChecker::wrong_after(const std::vector<Disc>& after) const {
    for (std::size_t i = 0; i < after.size(); ++i) {
        if (Found violation = not_finite(after[i], i)) {
            return violation;
        }
        if (after[i].x != discs_[i].x || after[i].y != discs_[i].y) {
            return format("disc %zu is at (%.17g, %.17g) instead of at (%.17g, %.17g)", i, after[i].x,
                          after[i].y, discs_[i].x, discs_[i].y);
        }
    }
    const double reach = 2 * rules_.walls.radius;
    for (const DiscsNearby& near : near_.all()) {
        const Disc& one = after[static_cast<std::size_t>(near.first)];
        const Disc& two = after[static_cast<std::size_t>(near.second)];
        Found violation;
        if (near.surely && near.at_wall()) {
            violation = at_end_.wall_colliding(after, near.first);
        } else if (near.surely && distance_of(seen_from(one, two)) < reach * (1 - 8 * rules_.epsilon())) {
            violation = at_end_.pair_colliding(after, {near.first, near.second});
        }
        if (violation) {
            return violation;
        }
    }
    return conservation_violation(discs_, after,
                                  overlapping_pairs(after, rules_.walls.radius, rules_.walls.rounding),
                                  rules_.walls, Impact::step_end);
}

} // namespace carom
