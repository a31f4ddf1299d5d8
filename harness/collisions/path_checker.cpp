#include "harness/collisions/path_checker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/collisions/exchange.hpp"
#include "harness/support/format.hpp"

namespace carom {
namespace {

/// Of so many pieces, and some for each disc, memory is not short; then they are searched.
constexpr std::size_t many_pieces = 65'536;

template <class Real> bool is_finite(const BasicDisc<Real>& disc) {
    return std::isfinite(disc.x + disc.y + disc.vx + disc.vy);
}

template <class Real> std::string at_time(Real time) {
    return format(" at time %.17g", static_cast<double>(time));
}

} // namespace

template <class Real>
PathChecker<Real>::PathChecker(const Scene& scene)
    : side_(static_cast<Real>(scene.side)), radius_(static_cast<Real>(scene.radius)),
      rounding_(side_, radius_, static_cast<Real>(scene.discs.size())), search_(scene, rounding_) {
    for (const Disc& disc : scene.discs) {
        paths_.push_back({disc_cast<Real>(disc), 0});
    }
}

template <class Real> void PathChecker<Real>::collided(const Collision<Real>& collision) {
    if (violation_) {
        return;
    }
    violation_ = violation_of(collision);
    if (violation_) {
        return;
    }
    now_ = collision.time;
    end_path(collision.first, now_, collision.first_after);
    if (!collision.at_wall()) {
        end_path(collision.second, now_, collision.second_after);
    }
    ++(collision.at_wall() ? wall_collisions_ : pair_collisions_);
    if (pieces_.size() > many_pieces + 4 * paths_.size()) {
        violation_ = search(now_);
    }
}

template <class Real>
std::optional<std::string> PathChecker<Real>::violation_of(const Collision<Real>& collision) {
    if (auto violation = unknown_discs(collision, static_cast<int>(paths_.size()))) {
        return violation;
    }
    if (!(collision.time >= now_)) {
        return format("a collision of time %.17g is told after one of time %.17g",
                      static_cast<double>(collision.time), static_cast<double>(now_));
    }
    for (const auto& [disc, after] : {std::pair{collision.first, collision.first_after},
                                      std::pair{collision.second, collision.second_after}}) {
        if (auto violation = off_path(disc, after, collision.time)) {
            return violation;
        }
        if (auto violation = beyond_wall(disc, collision.time)) {
            return violation;
        }
    }
    return collision.at_wall() ? wrong_wall(collision) : wrong_pair(collision);
}

/// Is a disc said to be where its path does not lead?
template <class Real>
std::optional<std::string> PathChecker<Real>::off_path(int disc, const BasicDisc<Real>& place, Real time) {
    const BasicDisc<Real> there = path(disc).at(time);
    const Real allowed = rounding_.place(path(disc), time);
    if (is_finite(place) && std::max(std::abs(place.x - there.x), std::abs(place.y - there.y)) <= allowed) {
        return std::nullopt;
    }
    return format("disc %d is at %s, and its path leads to %s,", disc, state_text(place).c_str(),
                  state_text(there).c_str()) +
           at_time(time);
}

template <class Real>
std::optional<std::string> PathChecker<Real>::wrong_pair(const Collision<Real>& collision) {
    const Path<Real>& first = path(collision.first);
    const Path<Real>& second = path(collision.second);
    const Real time = collision.time;
    const Real later = std::max(first.time, second.time);
    const Real distance_then = distance_of(seen_from(first.at(later), second.at(later)));
    const BasicDisc<Real> d = seen_from(first.at(time), second.at(time));
    const Real distance = distance_of(d);
    const Real place = rounding_.place(first, time) + rounding_.place(second, time);
    const Real allowed = place + rounding_.gap(speed_of(d), time, distance_then);
    const Real gap = distance - 2 * radius_;
    const auto who = [&] { return format("discs %d and %d", collision.first, collision.second); };
    if (!(gap <= allowed)) {
        return who() + format(" collide while they are %.3g apart", static_cast<double>(gap)) + at_time(time);
    }
    const Real nearer = std::min(2 * radius_, distance_then) - distance;
    if (!(nearer <= allowed)) {
        return who() + format(" collide when they are %.3g too near", static_cast<double>(nearer)) +
               at_time(time);
    }
    // Within the gap allowed of the nearest that a grazing pair comes, it may be seen to part a little.
    const Real most_parting = speed_of(d) * (std::sqrt(2 * (distance + radius_) * allowed) + allowed);
    if (!(parting_of(d) <= most_parting)) {
        return who() +
               format(" collide while they part at %.3g", static_cast<double>(parting_of(d) / distance)) +
               at_time(time);
    }
    Found violation = wrong_velocities(collision, first.start, second.start, d, PathRounding<Real>::epsilon,
                                       4 * (place / distance), true);
    return violation ? *violation + at_time(time) : violation;
}

/// How far a disc is beyond the wall that it flies to, along one axis.
template <class Real> Real PathChecker<Real>::beyond(Real position, Real velocity) const {
    return velocity < 0 ? radius_ - position : position - (side_ - radius_);
}

template <class Real>
std::optional<std::string> PathChecker<Real>::wrong_wall(const Collision<Real>& collision) {
    const Path<Real>& flown = path(collision.first);
    const BasicDisc<Real> before = flown.at(collision.time);
    const BasicDisc<Real>& after = collision.first_after;
    const bool in_x = after.vx == -before.vx && after.vy == before.vy && before.vx != 0;
    const bool in_y = after.vy == -before.vy && after.vx == before.vx && before.vy != 0;
    const auto who = [&] {
        return format("disc %d, of velocity (%.17g, %.17g),", collision.first, static_cast<double>(before.vx),
                      static_cast<double>(before.vy));
    };
    if (!in_x && !in_y) {
        return who() +
               format(" is given (%.17g, %.17g) by a wall", static_cast<double>(after.vx),
                      static_cast<double>(after.vy)) +
               at_time(collision.time);
    }
    const Real depth = in_x ? beyond(before.x, before.vx) : beyond(before.y, before.vy);
    const Real speed = std::abs(in_x ? before.vx : before.vy);
    const Real allowed =
        rounding_.place(flown, collision.time) + rounding_.gap(speed, collision.time, radius_);
    if (!(depth >= -allowed)) { // behind it no farther than it was: beyond_wall
        return who() + format(" is turned %.3g before a wall", static_cast<double>(-depth)) +
               at_time(collision.time);
    }
    return std::nullopt;
}

/// Has a disc flown farther beyond a wall than it was when its path began?
template <class Real> std::optional<std::string> PathChecker<Real>::beyond_wall(int disc, Real time) {
    const Path<Real>& flown = path(disc);
    const BasicDisc<Real> now = flown.at(time);
    if (std::min(now.x, now.y) >= radius_ && std::max(now.x, now.y) <= side_ - radius_) {
        return std::nullopt;
    }
    const Real place = rounding_.place(flown, time);
    const auto deeper = [&](Real before, Real after, Real velocity) {
        return beyond(after, velocity) - std::max(beyond(before, velocity), Real{0}) -
               (place + rounding_.gap(std::abs(velocity), time, radius_));
    };
    const Real depth = std::max(deeper(flown.start.x, now.x, now.vx), deeper(flown.start.y, now.y, now.vy));
    if (depth <= 0) {
        return std::nullopt;
    }
    return format("disc %d is %.3g beyond a wall, which did not turn it,", disc, static_cast<double>(depth)) +
           at_time(time);
}

template <class Real> void PathChecker<Real>::end_path(int disc, Real time, const BasicDisc<Real>& after) {
    const Real begin = std::max(path(disc).time, searched_);
    if (begin < time) {
        pieces_.push_back({static_cast<std::size_t>(disc), path(disc), begin, time});
    }
    path(disc) = {after, time};
}

/// Looks at all pieces of paths up to that time that have not been looked at.
template <class Real> std::optional<std::string> PathChecker<Real>::search(Real time) {
    for (std::size_t i = 0; i < paths_.size(); ++i) {
        const Real begin = std::max(paths_[i].time, searched_);
        if (begin < time) {
            pieces_.push_back({i, paths_[i], begin, time});
        }
    }
    return search_.too_near(std::exchange(pieces_, {}), std::exchange(searched_, time), time);
}

template <class Real>
std::optional<std::string> PathChecker<Real>::violation_at(Real time,
                                                           const std::vector<BasicDisc<Real>>& discs) {
    if (violation_) {
        return violation_;
    }
    if (discs.size() != paths_.size()) {
        return format("%zu discs became %zu", paths_.size(), discs.size());
    }
    if (!(time >= now_)) {
        return format("a collision of time %.17g is told before that time", static_cast<double>(now_));
    }
    now_ = time;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const int disc = static_cast<int>(i);
        if (auto violation = off_path(disc, discs[i], time)) {
            return violation;
        }
        if (discs[i].vx != paths_[i].start.vx || discs[i].vy != paths_[i].start.vy) {
            return format("disc %d is at %s, and its last collision left it (%.17g, %.17g),", disc,
                          state_text(discs[i]).c_str(), static_cast<double>(paths_[i].start.vx),
                          static_cast<double>(paths_[i].start.vy)) +
                   at_time(time);
        }
        if (auto violation = beyond_wall(disc, time)) {
            return violation;
        }
    }
    violation_ = search(time);
    return violation_;
}

template class PathChecker<double>;

} // namespace carom
