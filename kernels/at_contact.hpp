#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "collide.hpp"
#include "contacts.hpp"
#include "four_at_once.hpp"
#include "policies.hpp"
#include "probe.hpp"
#include "scene.hpp"
#include "state.hpp"
#include "tally.hpp"

// Impact::at_contact. At the end of a step the discs stand where they flew freely. Of every pair that is near
// each other the way back along its present motion is asked when it came into contact. Both discs then get
// the velocities that the collision of that moment gives them, and the places to which they have flown with
// these since. Discs at walls likewise. Here stands how one pair or disc collides so; in which sweeps all of
// them do, in at_contact_strips.hpp.
//
// The order is that of time: a sweep makes those collisions that are the earliest known of both of their
// discs. No two of these share a disc, so that they may be made in any order, and what a later one would do
// is asked anew, of the new paths, in the next sweep. So the result is that of one order of all collisions by
// time, whatever boxes, strips and threads there are. (But of two collisions of a disc at the same instant
// one is made, the first in the order of the strips, and the other one is asked again.)
//
// Why it ends: after `most_sweeps_at_contact`. A pair collides again within a step only later than before,
// and where the sweeps are not enough, what is left collides at the step's end, without being moved, as all
// do with Impact::step_end. Why discs stay where they belong: a collision keeps the energy of the pair, and
// moves neither disc farther than the pair flies, one relative to the other, in two steps. Discs that it
// moves into others not near them, or into a wall, are found in the next step, by the same way back.

namespace carom {

/// How far back, in time, discs may be followed from the end of a step.
template <class Real> struct WayBack {
    Real step; ///< through this step: for discs that have met and part
    Real all;  ///< through the step before as well, if there is one: for discs that move into each other,
               ///< since a collision of that step may have moved them there
};

template <Policies policies> using WayBackOf = WayBack<RealOf<policies.precision>>;

/// The motion of the second of two discs as the first one sees it: |d - v t|^2 = (2r)^2, with a = |v|^2, b =
/// d.v, c = |d|^2 - (2r)^2, at the times t ago at which they were in contact. `Number` is of one pair, or a
/// vector of those of several.
template <class Number> struct RelativeMotion {
    Number a;
    Number b;
    Number c;

    /// Did they come into contact within the way back, if they fly as they do now? They are apart at its
    /// beginning and, at its end or in between, nearer than 2r. Without a root, a quotient or a branch.
    template <class Real> [[gnu::always_inline]] auto met(const WayBack<Real>& back) const {
        const Number time = b < 0 ? Number{} + back.all : Number{} + back.step;
        const auto were_apart = c - time * (2 * b - a * time) > 0;
        const auto met_and_parted = (b > 0) & (b < a * time) & (b * b > a * c);
        return were_apart & ((c <= 0) | met_and_parted);
    }

    /// How long ago that was: the earlier moment, which is the larger root t = (b + sqrt(b^2 - a c)) / a.
    /// Where b < 0 the sum cancels and is multiplied out with its conjugate (Goldberg, ACM Computing Surveys
    /// 23, 5, 1991, section 1.4).
    Number time_since_contact() const {
        const Number root = std::sqrt(b * b - a * c);
        const bool approaching = b < 0;
        return (approaching ? -c : b + root) / (approaching ? root - b : a);
    }
};

template <class Real>
RelativeMotion<Real> motion_of(const BasicDisc<Real>& first, const BasicDisc<Real>& second,
                               Real reach_squared) {
    const Real dx = second.x - first.x;
    const Real dy = second.y - first.y;
    const Real vx = second.vx - first.vx;
    const Real vy = second.vy - first.vy;
    return {vx * vx + vy * vy, dx * vx + dy * vy, dx * dx + dy * dy - reach_squared};
}

/// The same of two pairs at once.
template <class Real>
[[gnu::always_inline]] inline auto motions_of_two(const std::array<OverlappingDiscs, 2>& pairs,
                                                  const BasicDisc<Real>* discs, Real reach_squared) {
    using Both = BothComponents<Real>;
    std::array<typename Both::Register, 2> d;
    std::array<typename Both::Register, 2> v;
    for (std::size_t n = 0; n < 2; ++n) {
        const auto& first = discs[pairs[n].first];
        const auto& second = discs[pairs[n].second];
        d[n] = Both::load_position(second) - Both::load_position(first);
        v[n] = Both::load_velocity(second) - Both::load_velocity(first);
    }
    return RelativeMotion<typename Both::Register>{sums(v[0] * v[0], v[1] * v[1]),
                                                   sums(d[0] * v[0], d[1] * v[1]),
                                                   sums(d[0] * d[0], d[1] * d[1]) - reach_squared};
}

/// The time since which a disc has been in a wall that it moves into, along one axis; below 0 if it is in
/// none, or has been for longer than the way back.
template <class Real>
Real time_in_wall(Real position, Real velocity, Real side, Real radius, const WayBack<Real>& back) {
    const bool inside = velocity < 0 ? position - radius <= 0 : velocity > 0 && position + radius >= side;
    const Real depth = velocity < 0 ? radius - position : position + radius - side;
    const Real time = depth / std::abs(velocity);
    return inside && time <= back.all ? std::max(time, Real{0}) : -1;
}

/// Makes the collision that two discs had `time` ago, if they did approach; returns whether they did.
template <class Real>
bool collide_back(Real time, BasicDisc<Real>& first, BasicDisc<Real>& second,
                  const ApproachTolerance<Real>& approaching) {
    const Real vx = second.vx - first.vx;
    const Real vy = second.vy - first.vy;
    const Real dx = second.x - first.x - vx * time;
    const Real dy = second.y - first.y - vy * time;
    const Real distance_squared = dx * dx + dy * dy;
    const Real approach = vx * dx + vy * dy;
    const Real speed_squared =
        first.vx * first.vx + first.vy * first.vy + (second.vx * second.vx + second.vy * second.vy);
    if (!(approach < 0) || (!approaching.surely_counts(approach, distance_squared * speed_squared) &&
                            !approaching.counts(approach, distance_squared, speed_squared))) {
        return false;
    }
    // All these distances are 2r. If (2r)^2 is a power of two, above which numbers lie twice as far apart as
    // below, |d|^2 is rounded to one side more often than to the other, and the energy rises with every
    // collision; 3 |d|^2 is away from any.
    const Real thrice_squared = 3 * dx * dx + 3 * dy * dy;
    const Real impulse_x = 3 * approach / thrice_squared * dx;
    const Real impulse_y = 3 * approach / thrice_squared * dy;
    first = {first.x + impulse_x * time, first.y + impulse_y * time, first.vx + impulse_x,
             first.vy + impulse_y};
    second = {second.x - impulse_x * time, second.y - impulse_y * time, second.vx - impulse_x,
              second.vy - impulse_y};
    return true;
}

/// Along one axis: turns a velocity, and the path since the wall was met.
template <class Real> void bounce_back(Real& position, Real& velocity, Real side, Real radius) {
    position = velocity < 0 ? 2 * radius - position : 2 * (side - radius) - position;
    velocity = -velocity;
}

/// How far back the discs may be followed from the end of the present step.
template <Policies policies>
WayBackOf<policies> way_back(const State<policies>& state, const Tuning& tuning) {
    using Real = RealOf<policies.precision>;
    const Real dt = Real{1} / static_cast<Real>(tuning.substeps);
    return {dt, dt * static_cast<Real>(state.steps_flown)};
}

/// When the discs of a near pair that has met came into contact, or a disc and a wall.
template <Policies policies>
RealOf<policies.precision> time_of(OverlappingDiscs discs, const State<policies>& state,
                                   const WayBackOf<policies>& back) {
    const auto& disc = state.disc(discs.first);
    if (discs.at_wall()) [[unlikely]] {
        return std::max(time_in_wall(disc.x, disc.vx, state.side, state.radius, back),
                        time_in_wall(disc.y, disc.vy, state.side, state.radius, back));
    }
    return motion_of(disc, state.disc(discs.second), state.reach_squared()).time_since_contact();
}

/// A disc bounces off the walls that it met at that time, before now.
template <Policies policies>
Changes bounce_at(RealOf<policies.precision> time, State<policies>& state, int i,
                  const WayBackOf<policies>& back) {
    auto& disc = state.disc(i);
    Changes changes;
    if (time_in_wall(disc.x, disc.vx, state.side, state.radius, back) == time) {
        bounce_back(disc.x, disc.vx, state.side, state.radius);
        ++changes.walls;
    }
    if (time_in_wall(disc.y, disc.vy, state.side, state.radius, back) == time) {
        bounce_back(disc.y, disc.vy, state.side, state.radius);
        ++changes.walls;
    }
    return changes;
}

/// Makes the collision that two discs, or a disc and a wall, had at that time; returns what it changed.
template <Policies policies>
[[gnu::always_inline]] inline Changes collide_at(RealOf<policies.precision> time, State<policies>& state,
                                                 OverlappingDiscs discs, const WayBackOf<policies>& back,
                                                 const ApproachToleranceOf<policies>& approaching) {
    if (discs.at_wall()) {
        return bounce_at(time, state, discs.first, back);
    }
    return {.pairs = collide_back(time, state.disc(discs.first), state.disc(discs.second), approaching)};
}

/// Tells a collision, if it was made.
template <Policies policies, class SomeProbe>
void tell(const Changes& made, RealOf<policies.precision> time, int sweep, const State<policies>& state,
          OverlappingDiscs discs, SomeProbe& probe) {
    if (made.any()) {
        const auto first = static_cast<std::size_t>(discs.first);
        const auto second = static_cast<std::size_t>(discs.second);
        probe.collided({static_cast<double>(time), sweep, state.number(discs.first),
                        state.number(discs.second), disc_cast<double>(state.discs[first]),
                        disc_cast<double>(state.discs[second])});
    }
}

} // namespace carom
