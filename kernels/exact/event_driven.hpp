#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "kernels/collide.hpp"
#include "kernels/exact/event_cells.hpp"
#include "kernels/exact/event_queue.hpp"
#include "kernels/exact/first_collision.hpp"
#include "kernels/exact/flight.hpp"
#include "kernels/probe.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// How far the reference goes before it gives up.
struct EventLimits {
    std::int64_t at_once = 10'000'000;                              ///< events at one instant
    std::int64_t in_all = std::numeric_limits<std::int64_t>::max(); ///< events since the start
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
/// invalidation; Lubachevsky, J. Comput. Phys. 94, 255, 1991). Discs look into the nine cells around them;
/// crossing into another cell is an event, too. The work of an
/// event does not depend on N, but where all discs no longer fit into a cache its time does: an event may be
/// anywhere, and what the next ones will read is asked for ahead.
///
/// Pairs that overlap, at the start or by rounding, collide at once if they approach and are ignored while
/// they part; so do walls. Centres that coincide have no normal and do not collide (first_collision.hpp).
///
/// `Log` is told every collision; CollisionLog<Real>& is one that can.
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
    EventDriven(Real side, Real radius, Log log)
        : log_(log), side_(side), walls_{radius, side - radius}, reach_squared_(4 * radius * radius) {}

    /// Goes back to the start of the scene it was built of and keeps its memory.
    void restart(const Scene& scene) {
        begin_flights(scene, flights_);
        begin(0, {.left = 0, .bottom = 0, .side = side_});
    }

    /// Goes on from `now` with these flights, as if there were no other discs: most of them in that square.
    void restart(std::span<const Flight<Real>> flights, Real now, const Square<Real>& square) {
        flights_.assign(flights.begin(), flights.end());
        begin(now, square);
    }

    /// Each disc since its last collision.
    const std::vector<Flight<Real>>& flights() const { return flights_; }

    /// Goes on to `time`, from 0 at the start. False if a limit is passed, with more events at one instant
    /// (as where a disc is wedged) or in all: it then stands at that instant.
    bool advance(Real time, const EventLimits& limits = {}) {
        std::int64_t at_once = 0;
        for (Real next = queue_.earliest_time(); next <= time; next = queue_.earliest_time()) {
            at_once = next > now_ ? 0 : at_once + 1;
            ++events_;
            if (at_once > limits.at_once || events_ > limits.in_all) {
                return false;
            }
            now_ = std::max(now_, next);
            if (flights_.size() > at_hand) {
                prefetch_what_comes();
            }
            happen(queue_.earliest(), next);
        }
        now_ = std::max(now_, time);
        return true;
    }

    /// Reverses all velocities: from here on the discs go back the way they came.
    void turn_back() {
        for (Flight<Real>& one : flights_) {
            one.move_to(now_);
            one.vx = -one.vx;
            one.vy = -one.vy;
            ++one.age;
        }
        for (int i = 0; i < static_cast<int>(flights_.size()); ++i) {
            look_ahead(i);
        }
    }

    /// The discs as they are now, disc i at index i.
    std::vector<BasicDisc<Real>> discs() const {
        std::vector<BasicDisc<Real>> result;
        result.reserve(flights_.size());
        for (const Flight<Real>& one : flights_) {
            const Real elapsed = now_ - one.time;
            result.push_back({one.x + one.vx * elapsed, one.y + one.vy * elapsed, one.vx, one.vy});
        }
        return result;
    }

    Real time() const { return now_; }

    /// Collisions, crossings from cell to cell, and collisions foreseen in vain.
    std::int64_t events() const { return events_; }
    std::int64_t pair_collisions() const { return pair_collisions_; }
    std::int64_t wall_collisions() const { return wall_collisions_; }

    /// The momentum that all four walls have taken up so far, the sum of 2 |v| over wall collisions, for unit
    /// mass.
    Real wall_impulse() const { return wall_impulse_; }

    /// What the walls have changed of the momentum of all discs along x and y, for unit mass.
    const std::array<Real, 2>& momentum_from_walls() const { return momentum_from_walls_; }

  private:
    static constexpr int wall_x = -2;
    static constexpr int wall_y = -3;
    static constexpr Real never = std::numeric_limits<Real>::infinity();
    static constexpr std::size_t at_hand = 4096; ///< discs in 256 KiB, which a second cache holds

    /// Puts the discs into cells, where they are by now, and looks ahead.
    void begin(Real now, const Square<Real>& square) {
        now_ = now;
        events_ = 0;
        pair_collisions_ = 0;
        wall_collisions_ = 0;
        wall_impulse_ = 0;
        momentum_from_walls_ = {};
        cells_.arrange(square, flights_.size(), walls_[0], most_cells_per_side_);
        nine_ = cells_.nine();
        queue_.clear(static_cast<int>(flights_.size()));
        for (int i = 0; i < static_cast<int>(flights_.size()); ++i) {
            Flight<Real>& one = flight(i);
            const Real elapsed = now - one.time;
            one.cell = cells_.cell_at(one.x + one.vx * elapsed, one.y + one.vy * elapsed);
            cells_.insert(i, one.cell);
        }
        for (int i = 0; i < static_cast<int>(flights_.size()); ++i) {
            look_ahead(i);
        }
    }

    Flight<Real>& flight(int i) { return flights_[static_cast<std::size_t>(i)]; }

    /// Asks for what the next events will read. Each thing must have arrived for the next to be known, so
    /// that it takes as many events: the disc; its cells and its partner; who is in its cells, and the cells
    /// of its partner; who is in those. No result depends on it.
    [[gnu::always_inline]] void prefetch_what_comes() {
        __builtin_prefetch(&flight(queue_.coming(3)));
        const Flight<Real>& third = flight(queue_.coming(2));
        prefetch_cells(third.cell);
        if (third.partner >= 0) {
            __builtin_prefetch(&flight(third.partner));
            queue_.prefetch(third.partner);
        }
        const Flight<Real>& second = flight(queue_.coming(1));
        prefetch_discs(second.cell);
        if (second.partner >= 0) {
            prefetch_cells(flight(second.partner).cell);
        }
        const Flight<Real>& first = flight(queue_.coming(0));
        if (first.partner >= 0) {
            prefetch_discs(flight(first.partner).cell);
        }
    }

    [[gnu::always_inline]] void prefetch_cells(int cell) const {
        for (const int middle : {cell - cells_.stride(), cell, cell + cells_.stride()}) {
            __builtin_prefetch(&cells_[middle - 1]);
            __builtin_prefetch(&cells_[middle + 1]);
        }
    }

    [[gnu::always_inline]] void prefetch_discs(int cell) {
        for (const int offset : nine_) {
            __builtin_prefetch(&flight(cells_[cell + offset].discs[0]));
            __builtin_prefetch(&flight(cells_[cell + offset].discs[1]));
        }
    }

    /// The next event of disc i, which has come up.
    void happen(int i, Real time) {
        Flight<Real>& one = flight(i);
        if (time < one.collision_time) {
            cross(i);
            return;
        }
        if (one.partner < 0) {
            one.move_to(one.collision_time);
            bounce(one);
            log_.collided(Collision<Real>{one.time, 0, i, i, disc_of(one), disc_of(one)});
        } else if (flight(one.partner).age == one.partner_age) {
            const int partner = one.partner;
            meet(std::min(i, partner), std::max(i, partner), one.collision_time);
            look_ahead(partner);
        }
        look_ahead(i);
    }

    void meet(int first, int second, Real time) {
        Flight<Real>& one = flight(first);
        Flight<Real>& other = flight(second);
        one.move_to(time);
        other.move_to(time);
        collide(one, other);
        log_.collided(Collision<Real>{time, 0, first, second, disc_of(one), disc_of(other)});
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

    void bounce(Flight<Real>& one) {
        Real& velocity = one.partner == wall_x ? one.vx : one.vy;
        velocity = -velocity;
        wall_impulse_ += 2 * std::abs(velocity);
        momentum_from_walls_[one.partner == wall_x ? 0 : 1] += 2 * velocity;
        ++one.age;
        ++wall_collisions_;
    }

    /// Puts disc i, which is at the edge of its cell, into the next one and looks into the cells that came
    /// into reach.
    void cross(int i) {
        Flight<Real>& one = flight(i);
        const bool in_y = time_to_crossing_y(one) < time_to_crossing_x(one);
        const int across = in_y ? 1 : cells_.stride();
        const int along = in_y ? cells_.stride() : 1;
        const int step = (in_y ? one.vy : one.vx) > 0 ? along : -along;
        cells_.remove(i, one.cell);
        one.cell += step;
        cells_.insert(i, one.cell);
        FirstCollision<Real> first(flights_, cells_, i, reach_squared_);
        for (const int offset : {step - across, step, step + across}) {
            first.look_into(one.cell + offset);
        }
        first.foresee();
        schedule(i);
    }

    /// Foresees the next event of disc i from nothing.
    void look_ahead(int i) {
        Flight<Real>& one = flight(i);
        one.collision_time = never;
        one.partner = Flight<Real>::nobody;
        foresee_wall(one, one.x, one.vx, wall_x);
        foresee_wall(one, one.y, one.vy, wall_y);
        FirstCollision<Real> first(flights_, cells_, i, reach_squared_);
        for (const int offset : nine_) {
            first.look_into(one.cell + offset);
        }
        if (one.time == now_) {
            first.template foresee<true>();
        } else {
            first.foresee();
        }
        schedule(i);
    }

    void foresee_wall(Flight<Real>& one, Real position, Real velocity, int wall) const {
        const Real time = one.time + time_to(walls_[velocity > 0 ? 1 : 0], position, velocity);
        one.partner = time < one.collision_time ? wall : one.partner;
        one.collision_time = std::min(one.collision_time, time);
    }

    /// How long until a disc is there along an axis, which it flies towards; at once if it is beyond.
    static Real time_to(Real target, Real position, Real velocity) {
        return velocity == 0 ? never : std::max((target - position) / velocity, Real(0));
    }

    Real time_to_crossing_x(const Flight<Real>& one) const {
        return time_to(cells_.edge_x(one.cell, one.vx > 0), one.x, one.vx);
    }

    Real time_to_crossing_y(const Flight<Real>& one) const {
        return time_to(cells_.edge_y(one.cell, one.vy > 0), one.y, one.vy);
    }

    void schedule(int i) {
        const Flight<Real>& one = flight(i);
        const Real crossing_time = one.time + std::min(time_to_crossing_x(one), time_to_crossing_y(one));
        const bool crosses = crossing_time < one.collision_time;
        queue_.set(i, crosses ? crossing_time : one.collision_time, crosses ? -1 : one.ranks_as(i));
    }

    [[no_unique_address]] Log log_;
    Real side_;                 ///< of the box
    std::array<Real, 2> walls_; ///< how far a centre comes, down and up
    Real reach_squared_;        ///< (2r)^2
    int most_cells_per_side_ = EventCells<Real>::most_per_side;
    Real now_ = 0;
    std::vector<Flight<Real>> flights_;
    EventCells<Real> cells_;
    std::array<int, 9> nine_{};
    EventQueue<Real> queue_;
    std::int64_t events_ = 0;
    std::int64_t pair_collisions_ = 0;
    std::int64_t wall_collisions_ = 0;
    Real wall_impulse_ = 0;
    std::array<Real, 2> momentum_from_walls_{};
};

} // namespace carom
