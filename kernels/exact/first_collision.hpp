#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kernels/collide.hpp"
#include "kernels/exact/event_cells.hpp"
#include "kernels/exact/flight.hpp"

namespace carom {

/// Whether and when two discs collide: |d + v t|^2 = (2r)^2 is a t^2 + 2 b t + c = 0 with a = |v|^2, b = d.v,
/// c = |d|^2 - (2r)^2.
template <class Real> struct Approach {
    Real b; ///< as above if they collide, and then below 0; else 0 or above
    Real c;
    Real discriminant; ///< b^2 - a c
};

/// Of a disc that has been moved to now and another one; `reach_squared` is (2r)^2. They collide if they
/// approach, b < 0, and come near enough, b^2 >= a c; but not with centres so close that |d|^2 has too few
/// bits left to give a normal.
template <class Real>
Approach<Real> approach(const Flight<Real>& one, const Flight<Real>& other, Real reach_squared) {
    const Real elapsed = one.time - other.time;
    const Real dx = other.x + other.vx * elapsed - one.x;
    const Real dy = other.y + other.vy * elapsed - one.y;
    const Real vx = other.vx - one.vx;
    const Real vy = other.vy - one.vy;
    const Real b = dx * vx + dy * vy;
    const Real distance_squared = dx * dx + dy * dy;
    const Real c = distance_squared - reach_squared;
    const Real discriminant = b * b - (vx * vx + vy * vy) * c;
    const Real b_if_apart = distance_squared >= coincident_squared<Real> ? b : Real(0);
    return {.b = discriminant >= 0 ? b_if_apart : Real(0), .c = c, .discriminant = discriminant};
}

/// How long until two discs collide that do. The earlier root is t = (-b - sqrt(b^2 - a c)) / a. Since b < 0
/// the numerator cancels; multiplied out with its conjugate it is t = c / (-b + sqrt(b^2 - a c)), a sum of
/// positive terms (Goldberg, ACM Computing Surveys 23, 5, 1991, section 1.4). Pairs that overlap, c < 0,
/// collide at once.
template <class Real> Real time_to_collision(const Approach<Real>& pair) {
    return std::max(pair.c, Real(0)) / (std::sqrt(pair.discriminant) - pair.b);
}

/// Finds, among the discs of some cells, the one that a disc, which has been moved to now, collides with
/// first.
///
/// All of them are gathered, then all approaches computed, then the times of those that collide: loops
/// without branches, of which a compiler computes two passes and more at once. Which of some ten discs near
/// by collide is as good as random, and a branch foretold wrongly costs as much as the arithmetic of several.
template <class Real> class FirstCollision {
  public:
    FirstCollision(std::vector<Flight<Real>>& flights, const EventCells<Real>& cells, int disc,
                   Real reach_squared)
        : flights_(flights), cells_(cells), disc_(static_cast<std::size_t>(disc)),
          reach_squared_(reach_squared) {}

    [[gnu::always_inline]] void look_into(int cell) {
        const auto& held = cells_[cell];
        assert(count_ + held.discs.size() <= most);
        for (std::size_t k = 0; k < held.discs.size(); ++k) {
            candidates_[count_ + k] = static_cast<std::size_t>(held.discs[k]);
        }
        count_ += static_cast<std::size_t>(std::min(held.count, cells_.at_hand));
        if (held.count > cells_.at_hand) [[unlikely]] {
            look_into_rest(held);
        }
    }

    /// Lets the disc foresee it, if it comes before the collision that the disc has foreseen.
    void foresee() {
        std::array<Real, most> b;
        std::array<Real, most> c;
        std::array<Real, most> discriminant;
        Flight<Real>& one = flights_[disc_];
        assert(count_ < most);
        candidates_[count_] = disc_; // it does not collide with itself, so that their number may be even
        const std::size_t even = count_ + count_ % 2;
        for (std::size_t k = 0; k < even; ++k) {
            const auto pair = approach(one, flights_[candidates_[k]], reach_squared_);
            b[k] = pair.b;
            c[k] = pair.c;
            discriminant[k] = pair.discriminant;
        }
        std::array<std::size_t, most> collide;
        std::size_t collisions = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            collide[collisions] = k;
            collisions += b[k] < 0 ? 1 : 0;
        }
        std::size_t first = most;
        Real first_time = one.collision_time;
        for (std::size_t m = 0; m < collisions; ++m) {
            const std::size_t k = collide[m];
            const Real time = one.time + time_to_collision<Real>({b[k], c[k], discriminant[k]});
            first = time < first_time ? k : first;
            first_time = std::min(first_time, time);
        }
        if (first != most) {
            one.collision_time = first_time;
            one.partner = static_cast<int>(candidates_[first]);
            one.partner_age = flights_[candidates_[first]].age;
        }
        count_ = 0;
    }

  private:
    static constexpr std::size_t most = 64;
    static constexpr std::size_t in_nine = 9 * EventCells<Real>::at_hand;

    [[gnu::noinline]] void look_into_rest(const typename EventCells<Real>::Cell& held) {
        int disc = held.discs.back();
        for (int k = cells_.at_hand; k < held.count; ++k) {
            disc = cells_.before(disc);
            candidates_[count_] = static_cast<std::size_t>(disc);
            ++count_;
            if (count_ + in_nine >= most) {
                foresee();
            }
        }
    }

    std::vector<Flight<Real>>& flights_;
    const EventCells<Real>& cells_;
    std::size_t disc_;
    Real reach_squared_;
    std::size_t count_ = 0;
    std::array<std::size_t, most> candidates_;
};

} // namespace carom
