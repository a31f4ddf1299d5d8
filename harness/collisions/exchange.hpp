#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "harness/support/format.hpp"
#include "harness/verify/disc_states.hpp"
#include "kernels/probe.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// Names discs that a collision tells of and that are not there, of `count`; or nothing.
inline std::optional<std::string> unknown_discs(const Collision<double>& collision, int count) {
    const auto is_disc = [count](int disc) { return disc >= 0 && disc < count; };
    if (is_disc(collision.first) && is_disc(collision.second)) {
        return std::nullopt;
    }
    return format("a collision of discs %d and %d is told, of %d", collision.first, collision.second, count);
}

/// What two discs of those velocities do wrong, and what a collision gives them.
inline std::string told_velocities(const Collision<double>& collision, const Disc& one, const Disc& two,
                                   const char* what) {
    const auto velocity = [](const Disc& disc) { return format("(%.17g, %.17g)", disc.vx, disc.vy); };
    return format("discs %d and %d, of velocities %s and %s, %s: they get %s and %s", collision.first,
                  collision.second, velocity(one).c_str(), velocity(two).c_str(), what,
                  velocity(collision.first_after).c_str(), velocity(collision.second_after).c_str());
}

/// What is wrong with the velocities that two discs, `one` and `two` before, get in a collision, or nothing:
/// they keep their momentum and their energy and exchange what they have along the line of centres, of which
/// `d` is the second seen from the first, to 16 roundings of their speeds, and to `direction` of these, by
/// which that line is uncertain. Centres that coincide have none: whatever they exchange is wrong, unless
/// they `may_coincide`.
inline std::optional<std::string> wrong_velocities(const Collision<double>& collision, const Disc& one,
                                                   const Disc& two, const Disc& d, double epsilon,
                                                   double direction, bool may_coincide) {
    const Disc& one_after = collision.first_after;
    const Disc& two_after = collision.second_after;
    const auto wrong = [&](const char* what) { return told_velocities(collision, one, two, what); };
    const double speeds = speed_of(one) + speed_of(two);
    const double roundings = 16 * epsilon * speeds;
    if (!(std::hypot(one_after.vx + two_after.vx - one.vx - two.vx,
                     one_after.vy + two_after.vy - one.vy - two.vy) <= roundings)) {
        return wrong("do not keep their momentum");
    }
    const auto squares = [](const Disc& first, const Disc& second) {
        return first.vx * first.vx + first.vy * first.vy + second.vx * second.vx + second.vy * second.vy;
    };
    if (!(std::abs(squares(one_after, two_after) - squares(one, two)) <= roundings * speeds)) {
        return wrong("do not keep their energy");
    }
    const double distance = distance_of(d);
    const double exchanged = parting_of(d) / distance;
    const double off = std::hypot(one.vx + exchanged * (d.x / distance) - one_after.vx,
                                  one.vy + exchanged * (d.y / distance) - one_after.vy);
    if (!(may_coincide && distance == 0) && !(off <= roundings + speeds * direction)) {
        return wrong("do not exchange what they have along the line of centres");
    }
    return std::nullopt;
}

} // namespace carom
