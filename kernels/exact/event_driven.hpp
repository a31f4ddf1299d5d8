#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/collide.hpp"
#include "kernels/exact/event_cells.hpp"
#include "kernels/exact/flight.hpp"
#include "kernels/exact/foresight.hpp"
#include "kernels/exact/wall_sums.hpp"
#include "kernels/probe.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// How far the reference goes before it gives up.
struct EventLimits {
    std::int64_t at_once = 10'000'000;                              ///< events at one instant
    std::int64_t in_all = std::numeric_limits<std::int64_t>::max(); ///< collisions since the start
};

/// The exact reference: what the time step tends to as dt -> 0. Discs fly freely from event to event; pairs
/// and walls collide at their exact times, in order (Alder and Wainwright, J. Chem. Phys. 31, 459, 1959).
/// Collisions of one instant happen in the order of their discs.
///
/// A disc's flight changes at its collisions alone, and the time of a collision is a function of the flights
/// that lead to it. So what becomes of the discs depends on nothing but the scene, to the last bit: not on
/// the cells, nor on when who looked ahead.
///
/// Each disc knows only its own next event, which stands in a queue of N times; an event whose partner has
/// collided since it was foreseen is noticed when it comes up, and the disc looks ahead anew (lazy
/// invalidation; Lubachevsky, J. Comput. Phys. 94, 255, 1991). That a disc crosses into another cell is an
/// event, too (foresight.hpp). The work of an event does not depend on N, but where all discs no longer fit
/// into a cache its time does: an event may be anywhere, and what the next ones will read is asked for ahead.
///
/// Pairs that overlap, at the start or by rounding, collide at once if they approach and are ignored while
/// they part; so do walls. Centres that coincide have no normal and do not collide (first_collision.hpp).
///
/// `Log` is told every collision, with the places of its discs; CollisionLog<Real>& is one that can. One that
/// has `met_wall(place, axis, velocity)` is told what walls do, too, and one that has
/// `will_change(place, flight)` how a disc flies before it collides.
template <class Real, class Log = NoCollisionLog> class EventDriven {
  public:
    /// So many cells a side at most: no result depends on it.
    explicit EventDriven(const Scene& scene, Log log = Log(),
                         int most_cells_per_side = EventCells<Real>::most_per_side)
        : EventDriven(static_cast<Real>(scene.side), static_cast<Real>(scene.radius), log) {
        most_cells_per_side_ = most_cells_per_side;
        restart(scene);
    }

    /// No discs yet, in a box of that side.
    EventDriven(Real side, Real radius, Log log) : log_(log), side_(side), foresight_(side, radius) {}

    /// Goes back to the start of the scene it was built of and keeps its memory.
    void restart(const Scene& scene) {
        begin_flights(scene, foresight_.flights());
        foresight_.numbers().clear();
        restart(0, {.left = 0, .bottom = 0, .width = side_, .height = side_}, scene.discs.size());
    }

    /// Goes on from `now` with the discs that foresight() holds, as if there were no others. In that area
    /// there are, or soon will be, about `expected` of them.
    void restart(Real now, const Area<Real>& area, std::size_t expected) {
        now_ = now;
        pair_collisions_ = 0;
        wall_collisions_ = 0;
        wall_sums_.clear(keeps_wall_sums ? foresight_.flights().size() : 0);
        foresight_.begin(now, area, expected, most_cells_per_side_);
    }

    /// The discs between events: some may be added, taken out or replaced.
    Foresight<Real>& foresight() { return foresight_; }
    const Foresight<Real>& foresight() const { return foresight_; }

    /// Goes on to `time`, from 0 at the start. False if a limit is passed, with more events at one instant
    /// (as where a disc is wedged) or more collisions in all: it then stands at that instant.
    bool advance(Real time, const EventLimits& limits = {}) {
        std::int64_t at_once = 0;
        for (Real next = foresight_.earliest_time(); next <= time; next = foresight_.earliest_time()) {
            at_once = next > now_ ? 0 : at_once + 1;
            if (at_once > limits.at_once) {
                return false;
            }
            now_ = std::max(now_, next);
            foresight_.prefetch();
            happen(foresight_.earliest(), next);
            if (pair_collisions_ + wall_collisions_ > limits.in_all) {
                return false;
            }
        }
        now_ = std::max(now_, time);
        return true;
    }

    /// The discs as they are now, disc i at index i.
    std::vector<BasicDisc<Real>> discs() const {
        std::vector<BasicDisc<Real>> result;
        result.reserve(foresight_.flights().size());
        for (const Flight<Real>& one : foresight_.flights()) {
            const Real elapsed = now_ - one.time;
            result.push_back({one.x + one.vx * elapsed, one.y + one.vy * elapsed, one.vx, one.vy});
        }
        return result;
    }

    Real time() const { return now_; }

    std::int64_t pair_collisions() const { return pair_collisions_; }
    std::int64_t wall_collisions() const { return wall_collisions_; }

    /// The momentum that all four walls have taken up so far, the sum of 2 |v| over wall collisions, for unit
    /// mass.
    Real wall_impulse() const { return wall_sums_.impulse(); }

    /// What the walls have changed of the momentum of all discs along x and y, for unit mass.
    std::array<Real, 2> momentum_from_walls() const { return wall_sums_.momentum(); }

  private:
    static constexpr bool keeps_wall_sums = !requires(Log& log) { log.met_wall(0, std::size_t{}, Real{}); };

    /// The next event of disc i, which has come up.
    void happen(int i, Real time) {
        Flight<Real>& one = foresight_.flight(i);
        if (time < one.collision_time) {
            foresight_.cross(i);
            return;
        }
        if (one.partner < 0) {
            will_change(i, one);
            one.move_to(one.collision_time);
            bounce(i, one);
            log_.collided(Collision<Real>{one.time, 0, i, i, disc_of(one), disc_of(one)});
        } else if (foresight_.flight(one.partner).age == one.partner_age) {
            const int partner = one.partner;
            meet(std::min(i, partner), std::max(i, partner), one.collision_time);
            foresight_.look_ahead(partner, now_);
        }
        foresight_.look_ahead(i, now_);
    }

    void meet(int first, int second, Real time) {
        Flight<Real>& one = foresight_.flight(first);
        Flight<Real>& other = foresight_.flight(second);
        will_change(first, one);
        will_change(second, other);
        one.move_to(time);
        other.move_to(time);
        collide(one, other);
        log_.collided(Collision<Real>{time, 0, first, second, disc_of(one), disc_of(other)});
    }

    void will_change(int i, const Flight<Real>& flight) {
        if constexpr (requires { log_.will_change(i, flight); }) {
            log_.will_change(i, flight);
        }
    }

    static BasicDisc<Real> disc_of(const Flight<Real>& one) { return {one.x, one.y, one.vx, one.vy}; }

    void collide(Flight<Real>& one, Flight<Real>& other) {
        const Real dx = other.x - one.x;
        const Real dy = other.y - one.y;
        const Real approach = (other.vx - one.vx) * dx + (other.vy - one.vy) * dy;
        const Real impulse = approach / (dx * dx + dy * dy);
        one.vx += impulse * dx;
        one.vy += impulse * dy;
        other.vx -= impulse * dx;
        other.vy -= impulse * dy;
        ++one.age;
        ++other.age;
        ++pair_collisions_;
    }

    void bounce(int i, Flight<Real>& one) {
        const std::size_t axis = one.partner == Foresight<Real>::wall_x ? 0 : 1;
        Real& velocity = axis == 0 ? one.vx : one.vy;
        velocity = -velocity;
        if constexpr (keeps_wall_sums) {
            wall_sums_.add(i, axis, velocity);
        } else {
            log_.met_wall(i, axis, velocity);
        }
        ++one.age;
        ++wall_collisions_;
    }

    [[no_unique_address]] Log log_;
    Real side_; ///< of the box
    int most_cells_per_side_ = EventCells<Real>::most_per_side;
    Real now_ = 0;
    Foresight<Real> foresight_;
    std::int64_t pair_collisions_ = 0;
    std::int64_t wall_collisions_ = 0;
    WallSums<Real> wall_sums_;
};

} // namespace carom
