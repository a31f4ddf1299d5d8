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

bool is_finite(const Disc& disc) { return std::isfinite(disc.x + disc.y + disc.vx + disc.vy); }

std::string at_time(double time) { return format(" at time %.17g", time); }

} // namespace

PathChecker::PathChecker(const Scene& scene, int substeps)
    : side_(scene.side), radius_(scene.radius), substeps_(substeps),
      search_(side_, radius_, scene.discs.size()), rounding_(search_.rounding()) {
    for (const Disc& disc : scene.discs) {
        paths_.push_back({disc, 0});
    }
}

void PathChecker::collided(const Collision<double>& collision) {
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

std::optional<std::string> PathChecker::violation_of(const Collision<double>& collision) {
    if (auto violation = unknown_discs(collision, static_cast<int>(paths_.size()))) {
        return violation;
    }
    if (!(collision.time >= now_)) {
        return format("a collision of time %.17g is told after one of time %.17g", collision.time, now_);
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
std::optional<std::string> PathChecker::off_path(int disc, const Disc& place, double time) {
    const Disc there = path(disc).at(time);
    const double allowed = rounding_.place(path(disc), time);
    if (is_finite(place) && std::max(std::abs(place.x - there.x), std::abs(place.y - there.y)) <= allowed) {
        return std::nullopt;
    }
    return format("disc %d is at %s, and its path leads to %s,", disc, state_text(place).c_str(),
                  state_text(there).c_str()) +
           at_time(time);
}

std::optional<std::string> PathChecker::wrong_pair(const Collision<double>& collision) {
    const Path& first = path(collision.first);
    const Path& second = path(collision.second);
    const double time = collision.time;
    const double later = std::max(first.time, second.time);
    const double distance_then = distance_of(seen_from(first.at(later), second.at(later)));
    const Disc d = seen_from(first.at(time), second.at(time));
    const double distance = distance_of(d);
    const double place = rounding_.place(first, time) + rounding_.place(second, time);
    const double allowed = place + rounding_.gap(speed_of(d), time, distance_then);
    const double gap = distance - 2 * radius_;
    const auto who = [&] { return format("discs %d and %d", collision.first, collision.second); };
    if (!(gap <= allowed)) {
        return who() + format(" collide while they are %.3g apart", gap) + at_time(time);
    }
    const double nearer = std::min(2 * radius_, distance_then) - distance;
    if (!(nearer <= allowed)) {
        return who() + format(" collide when they are %.3g too near", nearer) + at_time(time);
    }
    // Within the gap allowed of the nearest that a grazing pair comes, it may be seen to part a little.
    const double most_parting = speed_of(d) * (std::sqrt(2 * (distance + radius_) * allowed) + allowed);
    if (!(parting_of(d) <= most_parting)) {
        return who() + format(" collide while they part at %.3g", parting_of(d) / distance) + at_time(time);
    }
    Found violation = wrong_velocities(collision, first.start, second.start, d, PathRounding::epsilon,
                                       4 * (place / distance), true);
    return violation ? *violation + at_time(time) : violation;
}

/// How far a disc is beyond the wall that it flies to, along one axis.
double PathChecker::beyond(double position, double velocity) const {
    return velocity < 0 ? radius_ - position : position - (side_ - radius_);
}

std::optional<std::string> PathChecker::wrong_wall(const Collision<double>& collision) {
    const Path& flown = path(collision.first);
    const Disc before = flown.at(collision.time);
    const Disc& after = collision.first_after;
    const bool in_x = after.vx == -before.vx && after.vy == before.vy && before.vx != 0;
    const bool in_y = after.vy == -before.vy && after.vx == before.vx && before.vy != 0;
    const auto who = [&] {
        return format("disc %d, of velocity (%.17g, %.17g),", collision.first, before.vx, before.vy);
    };
    if (!in_x && !in_y) {
        return who() + format(" is given (%.17g, %.17g) by a wall", after.vx, after.vy) +
               at_time(collision.time);
    }
    const double depth = in_x ? beyond(before.x, before.vx) : beyond(before.y, before.vy);
    const double speed = std::abs(in_x ? before.vx : before.vy);
    const double allowed =
        rounding_.place(flown, collision.time) + rounding_.gap(speed, collision.time, radius_);
    if (!(depth >= -allowed)) { // behind it no farther than it was: beyond_wall
        return who() + format(" is turned %.3g before a wall", -depth) + at_time(collision.time);
    }
    return std::nullopt;
}

/// Has a disc flown farther beyond a wall than it was when its path began?
std::optional<std::string> PathChecker::beyond_wall(int disc, double time) {
    const Path& flown = path(disc);
    const Disc now = flown.at(time);
    if (std::min(now.x, now.y) >= radius_ && std::max(now.x, now.y) <= side_ - radius_) {
        return std::nullopt;
    }
    const double place = rounding_.place(flown, time);
    const auto deeper = [&](double before, double after, double velocity) {
        return beyond(after, velocity) - std::max(beyond(before, velocity), 0.0) -
               (place + rounding_.gap(std::abs(velocity), time, radius_));
    };
    const double depth = std::max(deeper(flown.start.x, now.x, now.vx), deeper(flown.start.y, now.y, now.vy));
    if (depth <= 0) {
        return std::nullopt;
    }
    return format("disc %d is %.3g beyond a wall, which did not turn it,", disc, depth) + at_time(time);
}

void PathChecker::end_path(int disc, double time, const Disc& after) {
    const double begin = std::max(path(disc).time, searched_);
    if (begin < time) {
        pieces_.push_back({static_cast<std::size_t>(disc), path(disc), begin, time});
    }
    path(disc) = {after, time};
}

/// Looks at all pieces of paths up to that time that have not been looked at.
std::optional<std::string> PathChecker::search(double time) {
    for (std::size_t i = 0; i < paths_.size(); ++i) {
        const double begin = std::max(paths_[i].time, searched_);
        if (begin < time) {
            pieces_.push_back({i, paths_[i], begin, time});
        }
    }
    return search_.too_near(std::exchange(pieces_, {}), std::exchange(searched_, time), time);
}

std::optional<std::string> PathChecker::violation_at(double time, const std::vector<Disc>& discs) {
    if (violation_) {
        return violation_;
    }
    if (discs.size() != paths_.size()) {
        return format("%zu discs became %zu", paths_.size(), discs.size());
    }
    if (!(time >= now_)) {
        return format("a collision of time %.17g is told before that time", now_);
    }
    now_ = time;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const int disc = static_cast<int>(i);
        if (auto violation = off_path(disc, discs[i], time)) {
            return violation;
        }
        if (discs[i].vx != paths_[i].start.vx || discs[i].vy != paths_[i].start.vy) {
            return format("disc %d is at %s, and its last collision left it (%.17g, %.17g),", disc,
                          state_text(discs[i]).c_str(), paths_[i].start.vx, paths_[i].start.vy) +
                   at_time(time);
        }
        if (auto violation = beyond_wall(disc, time)) {
            return violation;
        }
    }
    violation_ = search(time);
    return violation_;
}

} // namespace carom
