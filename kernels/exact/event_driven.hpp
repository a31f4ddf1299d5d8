#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/collide.hpp"
#include "kernels/exact/event_cells.hpp"
#include "kernels/exact/event_queue.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// How far the reference goes before it gives up.
struct EventLimits {
    std::int64_t at_once = 10'000'000;                              ///< events at one instant
    std::int64_t in_all = std::numeric_limits<std::int64_t>::max(); ///< events since the start
};

/// The exact reference: what the time step tends to as dt -> 0. Discs fly freely from event to event; pairs
/// and walls collide at their exact times, in order (Alder and Wainwright, J. Chem. Phys. 31, 459, 1959).
///
/// Each disc knows only its own next event, which stands in a queue of N times; an event whose partner has
/// collided since it was foreseen is noticed when it comes up, and the disc looks ahead anew (lazy
/// invalidation; Lubachevsky, J. Comput. Phys. 94, 255, 1991). Discs look into the nine cells around them and
/// are moved only when something happens to them; crossing into another cell is an event, too. O(log N) an
/// event.
///
/// Time of collision: |d + v t|^2 = (2r)^2 with a = |v|^2, b = d.v, c = |d|^2 - (2r)^2 has the earlier root
/// t = (-b - sqrt(b^2 - a c)) / a. Approaching discs have b < 0, so the numerator cancels; multiplied out
/// with its conjugate it is t = c / (-b + sqrt(b^2 - a c)), a sum of positive terms (Goldberg, ACM Computing
/// Surveys 23, 5, 1991, section 1.4). Pairs that overlap (c < 0), at the start or by rounding, collide at
/// once if they approach and are ignored while they part; so do walls. Centres so close that |d|^2 has too
/// few bits left to give a normal do not collide.
template <class Real> class EventDriven {
  public:
    explicit EventDriven(const Scene& scene)
        : side_(static_cast<Real>(scene.side)), radius_(static_cast<Real>(scene.radius)), cells_(scene),
          queue_(static_cast<int>(scene.discs.size())) {
        bodies_.reserve(scene.discs.size());
        for (const Disc& disc : scene.discs) {
            bodies_.push_back({.x = static_cast<Real>(disc.x),
                               .y = static_cast<Real>(disc.y),
                               .vx = static_cast<Real>(disc.vx),
                               .vy = static_cast<Real>(disc.vy)});
            const Body& one = bodies_.back();
            cells_.insert(static_cast<int>(bodies_.size()) - 1, cells_.along(one.y), cells_.along(one.x));
        }
        for (int i = 0; i < static_cast<int>(bodies_.size()); ++i) {
            look_ahead(i);
        }
    }

    /// Goes on to `time`, from 0 at the start. False if a limit is passed, with more events at one instant
    /// (as where a disc is wedged) or in all: it then stands at that instant.
    bool advance(Real time, const EventLimits& limits = {}) {
        std::int64_t at_once = 0;
        while (!queue_.empty() && queue_.earliest_time() <= time) {
            at_once = queue_.earliest_time() > now_ ? 0 : at_once + 1;
            ++events_;
            if (at_once > limits.at_once || events_ > limits.in_all) {
                return false;
            }
            now_ = std::max(now_, queue_.earliest_time());
            happen(queue_.earliest());
        }
        now_ = std::max(now_, time);
        return true;
    }

    /// Reverses all velocities: from here on the discs go back the way they came.
    void turn_back() {
        for (Body& body : bodies_) {
            move_to_now(body);
            body.vx = -body.vx;
            body.vy = -body.vy;
            ++body.age;
        }
        for (int i = 0; i < static_cast<int>(bodies_.size()); ++i) {
            look_ahead(i);
        }
    }

    /// The discs as they are now, disc i at index i.
    std::vector<BasicDisc<Real>> discs() const {
        std::vector<BasicDisc<Real>> result;
        result.reserve(bodies_.size());
        for (const Body& body : bodies_) {
            const Real elapsed = now_ - body.time;
            result.push_back({body.x + body.vx * elapsed, body.y + body.vy * elapsed, body.vx, body.vy});
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
    static constexpr int none = EventCells<Real>::none;
    static constexpr int wall_x = -2;
    static constexpr int wall_y = -3;
    static constexpr Real never = std::numeric_limits<Real>::infinity();

    struct Body {
        Real x = 0;
        Real y = 0;
        Real vx = 0;
        Real vy = 0;
        Real time = 0;                 ///< at which x and y are where it was
        Real collision_time = never;   ///< of the next collision foreseen
        Real crossing_time = never;    ///< of the next crossing into another cell
        int partner = none;            ///< of the next collision: a disc or a wall
        std::uint32_t partner_age = 0; ///< the partner's age when it was foreseen
        std::uint32_t age = 0;         ///< collisions so far
        bool crosses_row = false;
    };

    Body& body(int i) { return bodies_[static_cast<std::size_t>(i)]; }

    void move_to_now(Body& one) const {
        const Real elapsed = now_ - one.time;
        one.x += one.vx * elapsed;
        one.y += one.vy * elapsed;
        one.time = now_;
    }

    /// The next event of disc i, which has come up.
    void happen(int i) {
        Body& one = body(i);
        if (one.crossing_time < one.collision_time) {
            cross(i);
            return;
        }
        move_to_now(one);
        if (one.partner >= 0) {
            Body& other = body(one.partner);
            if (other.age == one.partner_age) {
                const int partner = one.partner;
                move_to_now(other);
                collide(one, other);
                look_ahead(partner);
            }
        } else {
            bounce(one);
        }
        look_ahead(i);
    }

    void collide(Body& one, Body& other) {
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

    void bounce(Body& one) {
        Real& velocity = one.partner == wall_x ? one.vx : one.vy;
        velocity = -velocity;
        wall_impulse_ += 2 * std::abs(velocity);
        momentum_from_walls_[one.partner == wall_x ? 0 : 1] += 2 * velocity;
        ++one.age;
        ++wall_collisions_;
    }

    /// Moves disc i, which is at the edge of its cell, into the next one and looks into the cells that came
    /// into reach.
    void cross(int i) {
        Body& one = body(i);
        move_to_now(one);
        const int row = cells_.place(i).row;
        const int column = cells_.place(i).column;
        const int step = (one.crosses_row ? one.vy : one.vx) > 0 ? 1 : -1;
        const int along = (one.crosses_row ? row : column) + step;
        cells_.remove(i);
        cells_.insert(i, one.crosses_row ? along : row, one.crosses_row ? column : along);
        const int ahead = along + step;
        if (ahead >= 0 && ahead < cells_.per_side()) {
            const int across = one.crosses_row ? column : row;
            for (int k = std::max(across - 1, 0); k <= std::min(across + 1, cells_.per_side() - 1); ++k) {
                foresee_cell(i, one.crosses_row ? ahead : k, one.crosses_row ? k : ahead);
            }
        }
        foresee_crossing(i);
        queue_.set(i, std::min(one.collision_time, one.crossing_time));
    }

    /// Foresees the next event of disc i, which has been moved to now, from nothing.
    void look_ahead(int i) {
        Body& one = body(i);
        one.collision_time = never;
        one.partner = none;
        foresee_wall(one, one.x, one.vx, wall_x);
        foresee_wall(one, one.y, one.vy, wall_y);
        const auto& place = cells_.place(i);
        const int last = cells_.per_side() - 1;
        for (int row = std::max(place.row - 1, 0); row <= std::min(place.row + 1, last); ++row) {
            for (int column = std::max(place.column - 1, 0); column <= std::min(place.column + 1, last);
                 ++column) {
                foresee_cell(i, row, column);
            }
        }
        foresee_crossing(i);
        queue_.set(i, std::min(one.collision_time, one.crossing_time));
    }

    void foresee_wall(Body& one, Real position, Real velocity, int wall) const {
        if (velocity == 0) {
            return;
        }
        const Real wall_position = velocity < 0 ? radius_ : side_ - radius_;
        const Real time = now_ + std::max((wall_position - position) / velocity, Real(0));
        if (time < one.collision_time) {
            one.collision_time = time;
            one.partner = wall;
        }
    }

    void foresee_cell(int i, int row, int column) {
        Body& one = body(i);
        for (int j = cells_.first_in(row, column); j != none; j = cells_.place(j).next) {
            if (j == i) {
                continue;
            }
            const Body& other = body(j);
            const Real time = now_ + time_to_collision(one, other);
            if (time < one.collision_time) {
                one.collision_time = time;
                one.partner = j;
                one.partner_age = other.age;
            }
        }
    }

    /// Of two discs, the first of which has been moved to now.
    Real time_to_collision(const Body& one, const Body& other) const {
        const Real elapsed = now_ - other.time;
        const Real dx = other.x + other.vx * elapsed - one.x;
        const Real dy = other.y + other.vy * elapsed - one.y;
        const Real vx = other.vx - one.vx;
        const Real vy = other.vy - one.vy;
        const Real b = dx * vx + dy * vy;
        if (!(b < 0)) {
            return never;
        }
        const Real distance_squared = dx * dx + dy * dy;
        if (distance_squared < coincident_squared<Real>) {
            return never;
        }
        const Real c = distance_squared - 4 * radius_ * radius_;
        if (c <= 0) {
            return Real(0);
        }
        const Real discriminant = b * b - (vx * vx + vy * vy) * c;
        return discriminant < 0 ? never : c / (std::sqrt(discriminant) - b);
    }

    void foresee_crossing(int i) {
        Body& one = body(i);
        const Real in_x = cells_.time_to_crossing(one.x, one.vx, cells_.place(i).column);
        const Real in_y = cells_.time_to_crossing(one.y, one.vy, cells_.place(i).row);
        one.crosses_row = in_y < in_x;
        one.crossing_time = now_ + std::min(in_x, in_y);
    }

    Real side_;
    Real radius_;
    Real now_ = 0;
    std::vector<Body> bodies_;
    EventCells<Real> cells_;
    EventQueue<Real> queue_;
    std::int64_t events_ = 0;
    std::int64_t pair_collisions_ = 0;
    std::int64_t wall_collisions_ = 0;
    Real wall_impulse_ = 0;
    std::array<Real, 2> momentum_from_walls_{};
};

} // namespace carom
