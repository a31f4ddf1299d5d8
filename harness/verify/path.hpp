#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/scene.hpp"

namespace carom {

/// The straight path of a disc since its last collision, as the list of collisions tells it.
struct Path {
    Disc start;
    double time = 0; ///< at which the disc is at its start

    Disc at(double now) const {
        const double elapsed = now - time;
        return {start.x + start.vx * elapsed, start.y + start.vy * elapsed, start.vx, start.vy};
    }

    /// How far the disc flies along x and along y, added.
    double length(double now) const { return (std::abs(start.vx) + std::abs(start.vy)) * (now - time); }
};

/// How far rounding may put an event-driven simulation from the paths that it tells, in lengths.
///
/// A place: the simulation moves a disc from event to event. Each move computes x + v t, which rounds three
/// times, by half an epsilon of numbers that are at most |x| + |v t|: 3/2 epsilon of it. A disc is moved at
/// each cell that it flies into, of which it meets no more than sqrt(N + 1) + 1 along each axis, nor more
/// than one each 2r; and where a collision was foreseen that another one prevented, for which 64 moves are
/// left room. The checker's own place is one such move.
///
/// A gap: the time of a collision is rounded to half an epsilon of itself, and is the root of a t^2 + 2 b t +
/// c = 0 with c = |d|^2 - (2r)^2, in which |d|^2 is rounded by an epsilon of itself or two. However near to
/// zero the root's discriminant is, that is the same as discs met at a |d|^2 wrong by so much: at a distance
/// wrong by |d|^2 / 4r of it, d being from where the later of both paths begins.
class PathRounding {
  public:
    PathRounding(double side, double radius, double discs)
        : side_(side), radius_(radius), cells_(2 * (std::sqrt(discs + 1) + 1)) {}

    double place(const Path& path, double now) const {
        const double length = path.length(now);
        const double moves = 64 + std::min(cells_, length / (2 * radius_));
        return 2 * epsilon * moves * (std::abs(path.start.x) + std::abs(path.start.y) + length);
    }

    /// Of two discs whose later path begins when they are `distance` apart, or of one and a wall.
    double gap(double speed, double now, double distance) const {
        return 8 * epsilon * (speed * now + side_ + distance * (distance / radius_));
    }

    static constexpr double epsilon = std::numeric_limits<double>::epsilon();

  private:
    double side_;
    double radius_;
    double cells_;
};

} // namespace carom
