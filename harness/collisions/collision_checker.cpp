#include "harness/collisions/collision_checker.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/collisions/exchange.hpp"
#include "harness/collisions/path_checker.hpp"
#include "harness/support/format.hpp"
#include "harness/verify/at_contact.hpp"
#include "harness/verify/checker.hpp"
#include "harness/verify/conservation.hpp"
#include "harness/verify/disc_states.hpp"
#include "harness/verify/overlapping_pairs.hpp"
#include "harness/verify/walls.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"

namespace carom {
namespace {

/// What a step with Impact::at_contact is made of.
struct ContactRules {
    Walls walls;
    double dt;
    double way_back; ///< how far back discs that move into each other are followed, in this step and before
    double near;     ///< discs within twice this at the end of their free flight are looked at
    Tolerance tolerance;

    double epsilon() const { return walls.rounding.epsilon(); }
};

/// When a collision was, before the end of the step, and how far rounding may put that time.
struct PastCollision {
    double time;
    double uncertain;
};

/// The motion of the second of two discs as the first one sees it, back from the end of a step.
///
/// Places and velocities are known to the last bit, so that the way d - v t is wrong by no more than some
/// roundings of |d| + |v t|, and its square, from which the time of contact is found, by as many of the
/// square of that and 2r: `uncertain`.
class PairBackwards {
  public:
    PairBackwards(const ContactRules& rules, const Disc& one, const Disc& two)
        : rules_(rules), d_(seen_from(one, two)), speeds_(std::hypot(speed_of(one), speed_of(two))),
          way_back_(parting_of(d_) < 0 ? rules.way_back : rules.dt) {
        const double farthest = distance_of(d_) + speed_of(d_) * way_back_ + reach();
        uncertain_ = 32 * rules.epsilon() * farthest * farthest;
    }

    double reach() const { return 2 * rules_.walls.radius; }
    double way_back() const { return way_back_; }

    /// Where the second disc was, seen from the first.
    Disc at(double time) const { return {d_.x - d_.vx * time, d_.y - d_.vy * time, d_.vx, d_.vy}; }

    /// How wrong the square of a distance may be.
    double uncertain() const { return uncertain_; }

    /// The collision that these two surely had, if they have flown as they do now: whatever the rounding,
    /// they were apart when the way back begins, have met since, and approached by more than what is let be.
    std::optional<PastCollision> surely_met() const {
        const double a = d_.vx * d_.vx + d_.vy * d_.vy;
        const double b = parting_of(d_);
        const double c = d_.x * d_.x + d_.y * d_.y - reach() * reach();
        const double discriminant = b * b - a * c;
        const double closing = std::sqrt(std::max(discriminant, 0.0));
        const bool were_apart = c - way_back_ * (2 * b - a * way_back_) > uncertain_;
        const double uncertain_b = 32 * rules_.epsilon() * std::sqrt(a) * (distance_of(d_) + reach());
        const bool parted = b > uncertain_b && b < a * way_back_ - uncertain_b;
        const bool in_contact = c < -uncertain_;
        if (!were_apart || !(in_contact || parted) || discriminant <= 4 * a * uncertain_ ||
            closing <= let_be()) {
            return std::nullopt;
        }
        const double time = b < 0 ? -c / (closing - b) : (b + closing) / a;
        const PastCollision met{time, uncertain_ / closing + 32 * rules_.epsilon() * time};
        const bool within = time > met.uncertain && time < way_back_ - met.uncertain;
        return within ? std::optional(met) : std::nullopt;
    }

  private:
    /// An approach, times 2r, that is not resolved; with as much again, since both round.
    double let_be() const {
        const double relative = 2 * 64 * rules_.epsilon() * reach() * speeds_;
        return rules_.tolerance == Tolerance::published ? std::max(relative, 2e-7) : relative;
    }

    const ContactRules& rules_;
    Disc d_;
    double speeds_;
    double way_back_;
    double uncertain_;
};

/// The time since which a disc has been in the wall that it moves into along one axis, as the variant's
/// precision has it; below 0 if it is in none, or has been for longer than the way back.
double time_in_wall(const ContactRules& rules, double position, double velocity) {
    const Walls& walls = rules.walls;
    const bool inside =
        velocity < 0 ? walls.touches_low(position) : velocity > 0 && walls.touches_high(position);
    const double depth = velocity < 0 ? walls.rounding(walls.radius - position)
                                      : walls.rounding(walls.rounding(position + walls.radius) - walls.side);
    const double time = inside ? walls.rounding(depth / std::abs(velocity)) : -1;
    return time <= rules.way_back ? time : -1;
}

/// Two discs near each other at the end of their free flight, or a disc near a wall, as both.
struct DiscsNearby {
    int first;
    int second;
    bool surely; ///< whatever the rounding
    double last; ///< how long before the step's end they last collided; infinity if they did not

    bool at_wall() const { return first == second; }
};

/// All of them in a step, and those of each disc.
class NearDiscs {
  public:
    void find(const std::vector<Disc>& free, const ContactRules& rules) {
        constexpr double never = std::numeric_limits<double>::infinity();
        const double roundings = 32 * rules.epsilon();
        pairs_.clear();
        for (const OverlappingPair& pair : overlapping_pairs(free, rules.near * (1 + roundings))) {
            const Disc& one = free[static_cast<std::size_t>(pair.first)];
            const Disc& two = free[static_cast<std::size_t>(pair.second)];
            const double distance = distance_of(seen_from(one, two));
            pairs_.push_back({pair.first, pair.second, distance < 2 * rules.near * (1 - roundings), never});
        }
        const double slack = roundings * (rules.near + rules.walls.side);
        for (int i = 0; i < static_cast<int>(free.size()); ++i) {
            const Disc& disc = free[static_cast<std::size_t>(i)];
            const double to_wall =
                std::min(std::min(disc.x, disc.y), rules.walls.side - std::max(disc.x, disc.y));
            if (to_wall <= rules.near + slack) {
                pairs_.push_back({i, i, to_wall < rules.near - slack, never});
            }
        }
        sort_by_disc(free.size());
    }

    const std::vector<DiscsNearby>& all() const { return pairs_; }

    /// Where in `all` those of a disc stand.
    const std::vector<std::size_t>& places_of(int disc) const {
        return places_[static_cast<std::size_t>(disc)];
    }

    /// That of two discs, or of one and a wall, or null.
    DiscsNearby* find_pair(int first, int second) {
        for (const std::size_t place : places_of(first)) {
            DiscsNearby& pair = pairs_[place];
            if ((pair.first == first && pair.second == second) ||
                (pair.first == second && pair.second == first)) {
                return &pair;
            }
        }
        return nullptr;
    }

  private:
    void sort_by_disc(std::size_t discs) {
        places_.resize(discs);
        for (auto& places : places_) {
            places.clear();
        }
        for (std::size_t place = pairs_.size(); place-- > 0;) {
            places_[static_cast<std::size_t>(pairs_[place].first)].push_back(place);
            if (!pairs_[place].at_wall()) {
                places_[static_cast<std::size_t>(pairs_[place].second)].push_back(place);
            }
        }
    }

    std::vector<DiscsNearby> pairs_;
    std::vector<std::vector<std::size_t>> places_; ///< of each disc
};

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

/// Goes through the collisions at contact that a variant tells, step by step, with a search and an arithmetic
/// of its own. What holds of every step:
///  - Discs fly freely to its end, to the last bit. From there each collision is followed back by the motion
///    that its discs have when it is made: at its time they were 2r apart and approaching, or a disc touched
///    a wall; it is within the way back, and before the last one of the same two.
///  - The two exchange the components of their velocities along the line of centres of that moment, and these
///    alone, which keeps their momentum and energy, and are where they have flown with them since. A wall
///    turns one component, and the path.
///  - Earliest first: neither disc surely had an earlier collision that was pending when this one was made,
///    and no disc has two in one sweep.
///  - None is left, unless the sweeps were not enough.
///  - After the last of them all discs stay where they are, to the last bit. What still overlaps is resolved
///    as at a step's end: nothing that is near is left colliding, and what is to be conserved is.
///
/// "Surely" is whatever the rounding of the variant's precision, as PairBackwards has it.
class ContactChecker final : public CollisionChecker {
  public:
    ContactChecker(const Scene& scene, const Policies& policies, const Tuning& tuning)
        : at_end_(scene.side, scene.radius, 1.0 / tuning.substeps, tuning.tolerance, rounding_of(policies)),
          rules_(rules_of(scene, policies, tuning)) {}

    void collided(const Collision<double>& collision) override {
        const std::lock_guard lock(telling_);
        collisions_.push_back(collision);
    }
    std::optional<std::string> step(const std::vector<Disc>& before,
                                    const std::vector<Disc>& after) override {
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

  private:
    using Found = std::optional<std::string>;

    /// All collisions of a sweep are looked at before the first of them is made: what they were chosen by.
    Found collide_sweeps() {
        sweeps_ = 0;
        std::vector<int> collided_in(discs_.size(), -1);
        const auto takes_part = [&](int i, int sweep) {
            return std::exchange(collided_in[static_cast<std::size_t>(i)], sweep) == sweep;
        };
        for (auto begin = collisions_.begin(); begin != collisions_.end();) {
            const int sweep = begin->sweep;
            const auto end = std::find_if(begin, collisions_.end(), [sweep](const auto& collision) {
                return collision.sweep != sweep;
            });
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

    Found violation_of(const Collision<double>& collision) {
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

    Found wrong_pair(const Collision<double>& collision) const {
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
    Found wrong_exchange(const Collision<double>& collision, const Disc& d, double uncertain) const {
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
            return !(std::hypot(after.x - x, after.y - y) <=
                     16 * epsilon * (extent + speeds * collision.time));
        };
        if (astray(one, collision.first_after) || astray(two, collision.second_after)) {
            return told_velocities(collision, one, two, "are not where they have flown since") +
                   when(collision);
        }
        return std::nullopt;
    }

    Found wrong_wall(const Collision<double>& collision) const {
        const Disc& before = disc(collision.first);
        const Disc& after = collision.first_after;
        const double low = rules_.walls.radius;
        const double high = rules_.walls.side - rules_.walls.radius;
        int turned = 0;
        const auto is_right = [&](double position, double velocity, double new_position,
                                  double new_velocity) {
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
    Found earlier(int i, const Collision<double>& collision) const {
        for (const std::size_t place : near_.places_of(i)) {
            const DiscsNearby& near = near_.all()[place];
            const auto pending = surely_pending(near);
            if (pending &&
                pending->time - pending->uncertain > collision.time * (1 + 32 * rules_.epsilon())) {
                return format("discs %d and %d collide before discs %d and %d, which met earlier, %.17g "
                              "before the end",
                              collision.first, collision.second, near.first, near.second, pending->time) +
                       when(collision);
            }
        }
        return std::nullopt;
    }

    std::optional<PastCollision> surely_pending(const DiscsNearby& near) const {
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

    Found left_pending() const {
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

    Found wrong_after(const std::vector<Disc>& after) const {
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

    const Disc& disc(int i) const { return discs_[static_cast<std::size_t>(i)]; }

    Checker at_end_; ///< of what is resolved at the step's end
    ContactRules rules_;
    int steps_ = 0;
    std::mutex telling_;
    std::vector<Collision<double>> collisions_; ///< of this step
    std::vector<Disc> discs_;                   ///< at its end, as far as collisions have been made
    NearDiscs near_;                            ///< at the end of the free flight
    int sweeps_ = 0;                            ///< in which something collided
};

} // namespace

std::unique_ptr<CollisionChecker> collision_checker(const Scene& scene, const Variant& variant,
                                                    const Tuning& tuning) {
    if (variant.engine == Engine::event_driven) {
        return std::make_unique<PathChecker>(scene, tuning.substeps);
    }
    if (variant.policies.impact == Impact::at_contact) {
        return std::make_unique<ContactChecker>(scene, variant.policies, tuning);
    }
    return nullptr;
}

} // namespace carom
