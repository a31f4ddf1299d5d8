#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "kernels/collide.hpp"
#include "kernels/exact/event_cells.hpp"
#include "kernels/exact/flight.hpp"

namespace carom {

/// Two discs that fly as they do since the later of their last collisions: |d + v t|^2 = (2r)^2 is
/// a t^2 + 2 b t + c = 0 with a = |v|^2, b = d.v, c = |d|^2 - (2r)^2.
template <class Real> struct Approach {
    Real b;
    Real distance_squared; ///< |d|^2
    Real discriminant;     ///< b^2 - a c

    /// They collide if they approach, b < 0, and come near enough, b^2 >= a c; but not with centres so close
    /// that |d|^2 has too few bits left to give a normal.
    bool collide() const {
        return (b < 0) & (discriminant >= 0) & (distance_squared >= coincident_squared<Real>);
    }
};

/// Of two discs; `reach_squared` is (2r)^2.
///
/// It is a function of the two flights alone, and the same for either disc to the last bit: not of when, and
/// of which of the two, it is asked. b^2 - a c is a (2r)^2 - (d x v)^2 by Lagrange's identity; so written it
/// does not cancel where discs come from afar, |d| >> 2r.
///
/// `is_latest`: `one` collided last, no other after it. Then it need not be moved, to the same bits.
template <bool is_latest = false, class Real>
Approach<Real> approach(const Flight<Real>& one, const Flight<Real>& other, Real reach_squared) {
    const Real later = other.time - one.time;
    // Exactly later or 0, and 0 or -later: without a branch, which would keep a compiler from taking two
    // pairs at once.
    const Real one_flown = is_latest ? Real(0) : (later + std::abs(later)) / 2;
    const Real other_flown = one_flown - later;
    const Real one_x = is_latest ? one.x : one.x + one.vx * one_flown;
    const Real one_y = is_latest ? one.y : one.y + one.vy * one_flown;
    const Real dx = (other.x + other.vx * other_flown) - one_x;
    const Real dy = (other.y + other.vy * other_flown) - one_y;
    const Real vx = other.vx - one.vx;
    const Real vy = other.vy - one.vy;
    const Real across = dx * vy - dy * vx;
    return {.b = dx * vx + dy * vy,
            .distance_squared = dx * dx + dy * dy,
            .discriminant = (vx * vx + vy * vy) * reach_squared - across * across};
}

/// How long after the later of their last collisions two discs collide that do. The earlier root is
/// t = (-b - sqrt(b^2 - a c)) / a. Since b < 0 the numerator cancels; multiplied out with its conjugate it is
/// t = c / (-b + sqrt(b^2 - a c)), a sum of positive terms (Goldberg, ACM Computing Surveys 23, 5, 1991,
/// section 1.4). Pairs that overlap, c < 0, collide at once.
template <class Real> Real time_to_collision(const Approach<Real>& pair, Real reach_squared) {
    const Real c = pair.distance_squared - reach_squared;
    return std::max(c, Real(0)) / (std::sqrt(pair.discriminant) - pair.b);
}

/// Finds, among the discs of some cells, the one that a disc collides with first; of several at one instant
/// the one of the lowest number, where a wall has the disc's own. `numbers` are those of the discs; if there
/// are none, their places are.
///
/// All of them are gathered, then all approaches computed, then the times of those that collide: loops
/// without branches, of which a compiler computes two passes and more at once. Which of some ten discs near
/// by collide is as good as random, and a branch foretold wrongly costs as much as the arithmetic of several.
template <class Real> class FirstCollision {
  public:
    FirstCollision(std::vector<Flight<Real>>& flights, const EventCells<Real>& cells,
                   const std::vector<int>& numbers, int disc, Real reach_squared)
        : flights_(flights), cells_(cells), numbers_(numbers), disc_(static_cast<std::size_t>(disc)),
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

    /// Lets the disc foresee it, if it comes before the collision that the disc has foreseen. `is_latest`: no
    /// disc has collided since this one did.
    template <bool is_latest = false> void foresee() {
        std::array<Real, most> b;
        std::array<Real, most> distance_squared;
        std::array<Real, most> discriminant;
        Flight<Real>& one = flights_[disc_];
        assert(count_ < most);
        candidates_[count_] = disc_; // it does not collide with itself, so that their number may be even
        const std::size_t even = count_ + count_ % 2;
        for (std::size_t k = 0; k < even; ++k) {
            const auto pair = approach<is_latest>(one, flights_[candidates_[k]], reach_squared_);
            b[k] = pair.b;
            distance_squared[k] = pair.distance_squared;
            discriminant[k] = pair.discriminant;
        }
        std::array<std::size_t, most> collide;
        std::size_t collisions = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            collide[collisions] = k;
            collisions += Approach<Real>{b[k], distance_squared[k], discriminant[k]}.collide() ? 1 : 0;
        }
        std::size_t first = most;
        Real first_time = one.collision_time;
        bool tied = false;
        for (std::size_t m = 0; m < collisions; ++m) {
            const std::size_t k = collide[m];
            const Real time = time_with(k, {b[k], distance_squared[k], discriminant[k]});
            tied = (time == first_time) | (tied & (time > first_time));
            first = time < first_time ? k : first;
            first_time = std::min(first_time, time);
        }
        if (tied) [[unlikely]] {
            first = lowest_at(first_time);
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

    /// When the disc collides with a candidate.
    Real time_with(std::size_t candidate, const Approach<Real>& pair) const {
        return std::max(flights_[disc_].time, flights_[candidates_[candidate]].time) +
               time_to_collision(pair, reach_squared_);
    }

    /// Of those with which it collides then, the one of the lowest number; `most` if that is what the disc
    /// has foreseen already.
    [[gnu::noinline]] std::size_t lowest_at(Real time) const {
        const Flight<Real>& one = flights_[disc_];
        std::size_t lowest = most;
        const auto foreseen = static_cast<std::size_t>(one.beside(static_cast<int>(disc_)));
        int number = one.collision_time == time ? number_of(foreseen) : std::numeric_limits<int>::max();
        for (std::size_t k = 0; k < count_; ++k) {
            const auto pair = approach(one, flights_[candidates_[k]], reach_squared_);
            if (pair.collide() && number_of(candidates_[k]) < number && time_with(k, pair) == time) {
                lowest = k;
                number = number_of(candidates_[k]);
            }
        }
        return lowest;
    }

    int number_of(std::size_t disc) const {
        return numbers_.empty() ? static_cast<int>(disc) : numbers_[disc];
    }

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
    const std::vector<int>& numbers_;
    std::size_t disc_;
    Real reach_squared_;
    std::size_t count_ = 0;
    std::array<std::size_t, most> candidates_;
};

} // namespace carom
