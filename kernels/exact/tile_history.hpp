#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/exact/tile_grid.hpp"
#include "kernels/probe.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// What became of a disc in one collision.
template <class Real> struct Change {
    Real time;
    int partner; ///< the number of a disc in the scene; `wall` for a wall
    int next;    ///< of the same disc's changes; `none` after the last
    BasicDisc<Real> after;

    static constexpr int wall = -1;
    static constexpr int none = -1;

    bool is_as(const Change& other) const {
        return time == other.time && partner == other.partner && after == other.after;
    }
};

/// A disc in a tile: one that it owns, or a copy. Followed are copies, and discs of which others have copies.
struct Held {
    int disc; ///< its number in the scene
    bool owned;
    bool followed;
};

/// What happens in one tile during one window (event_windows.hpp): to the discs that it owns, those within
/// its bounds at the beginning, and to copies of those around it. Discs are told by their places in `held`,
/// where their numbers rise.
template <class Real> class TileHistory {
  public:
    Bounds<Real> bounds; ///< of the tile; infinite beyond the walls
    std::vector<Held> held;
    bool ended = true; ///< did the collisions of each instant come to an end?

    /// Forgets the last window. All discs are known.
    void begin() {
        changes_.clear();
        first_.assign(held.size(), Change<Real>::none);
        last_.assign(held.size(), Change<Real>::none);
        excursion_ = 0;
        clearance_ = Bounds<Real>::infinity;
        pair_collisions_ = 0;
        wall_collisions_ = 0;
    }

    /// Is told every collision in the tile.
    void collided(const Collision<Real>& one) {
        const bool counts = held[place(one.first)].owned;
        pair_collisions_ += counts && !one.at_wall() ? 1 : 0;
        wall_collisions_ += counts && one.at_wall() ? 1 : 0;
        change(one.first, one.at_wall() ? Change<Real>::wall : held[place(one.second)].disc, one.time,
               one.first_after);
        if (!one.at_wall()) {
            change(one.second, held[place(one.first)].disc, one.time, one.second_after);
        }
    }

    /// An owned disc is there, at a collision or at the end of the window.
    void owned_is_at(int disc, const std::array<Real, 2>& point) {
        const Real depth = bounds.depth(point);
        excursion_ = std::max(excursion_, -depth);
        if (!held[place(disc)].followed) {
            clearance_ = std::min(clearance_, depth);
        }
    }

    const Change<Real>* first(int disc) const { return change_at(first_[place(disc)]); }
    const Change<Real>* after(const Change<Real>& one) const { return change_at(one.next); }

    /// How far an owned disc came out of the bounds at most.
    Real excursion() const { return excursion_; }
    /// How far inside the bounds every owned disc stayed of which there is no copy.
    Real clearance() const { return clearance_; }

    /// Of the discs that the tile owns; those of two tiles count where the one of the lower number is owned.
    std::int64_t pair_collisions() const { return pair_collisions_; }
    std::int64_t wall_collisions() const { return wall_collisions_; }

  private:
    static std::size_t place(int disc) { return static_cast<std::size_t>(disc); }

    const Change<Real>* change_at(int index) const {
        return index == Change<Real>::none ? nullptr : &changes_[static_cast<std::size_t>(index)];
    }

    void change(int disc, int partner, Real time, const BasicDisc<Real>& after) {
        if (held[place(disc)].owned) {
            owned_is_at(disc, {after.x, after.y});
        }
        if (!held[place(disc)].followed) {
            return;
        }
        const int index = static_cast<int>(changes_.size());
        int& last = last_[place(disc)];
        (last == Change<Real>::none ? first_[place(disc)] : changes_[place(last)].next) = index;
        last = index;
        changes_.push_back({time, partner, Change<Real>::none, after});
    }

    std::vector<Change<Real>> changes_;
    std::vector<int> first_; ///< of each disc's changes
    std::vector<int> last_;
    Real excursion_ = 0;
    Real clearance_ = 0;
    std::int64_t pair_collisions_ = 0;
    std::int64_t wall_collisions_ = 0;
};

} // namespace carom
