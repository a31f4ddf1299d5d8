#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/exact/flight.hpp"
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
        return same_bits(time, other.time) && partner == other.partner && same_bits(after.x, other.after.x) &&
               same_bits(after.y, other.after.y) && same_bits(after.vx, other.after.vx) &&
               same_bits(after.vy, other.after.vy);
    }
};

/// A disc in a tile.
struct Held {
    static constexpr int nobody = -1;

    int disc = nobody; ///< its number in the scene; `nobody` where no disc is
    int owner = 0;     ///< the tile that owns it,
    int place = 0;     ///< and its place there

    bool operator==(const Held&) const = default;
};

/// What a disc is to a tile: a copy of one that another tile owns; owned, and others have copies; owned, and
/// no other tile has a copy. What becomes of the former two is remembered.
enum class Kind : char { copy, shared, own };

/// What happens in one tile during one window (event_windows.hpp): to the discs that it owns, and to copies
/// of those around it. Discs are told by their places in `held`.
template <class Real> class TileHistory {
  public:
    /// A wall has turned the velocity of an owned disc along an axis, which is now so.
    struct AtWall {
        int disc;
        std::size_t axis;
        Real velocity;
    };

    /// A collision by the numbers of the discs, and which of them the tile owns.
    struct Listed {
        Collision<Real> collision;
        bool owns_first;
        bool owns_second;
    };

    Bounds<Real> bounds; ///< of the tile; infinite beyond the walls
    std::vector<Held> held;
    std::vector<Kind> kinds;         ///< of each of `held`
    std::vector<Flight<Real>> began; ///< each one when the window began
    bool ended = true;               ///< did the collisions of each instant come to an end?
    bool lists_collisions = false;   ///< are all collisions of owned discs to be listed?

    /// Forgets the last window. All discs are known.
    void begin() {
        changes_.clear();
        at_walls_.clear();
        collisions_.clear();
        first_.assign(held.size(), Change<Real>::none);
        last_.assign(held.size(), Change<Real>::none);
        excursion_ = 0;
        clearance_ = Bounds<Real>::infinity;
        pair_collisions_ = 0;
    }

    /// Is told every collision in the tile.
    void collided(const Collision<Real>& one) {
        if (kind(one.first) == Kind::own && kind(one.second) == Kind::own) {
            pair_collisions_ += one.at_wall() ? 0 : 1;
            own_is_at({one.first_after.x, one.first_after.y});
            own_is_at({one.second_after.x, one.second_after.y});
        } else {
            remember(one);
        }
        if (lists_collisions && (owns(one.first) || owns(one.second))) {
            list(one, held[index(one.first)].disc, held[index(one.second)].disc);
        }
    }

    /// Is told what the walls do.
    void met_wall(int place, std::size_t axis, Real velocity) {
        if (owns(place)) {
            at_walls_.push_back({held[index(place)].disc, axis, velocity});
        }
    }

    /// A disc of which there are no copies is there, at a collision or at the end of the window.
    void own_is_at(const std::array<Real, 2>& point) {
        clearance_ = std::min(clearance_, bounds.depth(point));
    }
    /// The same of one of which there are copies.
    void shared_is_at(const std::array<Real, 2>& point) {
        excursion_ = std::max(excursion_, -bounds.depth(point));
    }

    Kind kind(int place) const { return kinds[index(place)]; }
    bool owns(int place) const { return kind(place) != Kind::copy; }

    const Change<Real>* first(int place) const { return change_at(first_[index(place)]); }
    const Change<Real>* after(const Change<Real>& one) const { return change_at(one.next); }

    /// How far an owned disc of which there are copies came out of the bounds at most.
    Real excursion() const { return excursion_; }
    /// How far inside the bounds every owned disc stayed of which there are none.
    Real clearance() const { return clearance_; }

    /// Of owned discs; those of two tiles count where the disc of the lower number is owned.
    std::int64_t pair_collisions() const { return pair_collisions_; }
    const std::vector<AtWall>& at_walls() const { return at_walls_; }
    /// In order, by the numbers of the discs, if they are listed: all in which an owned disc has part.
    const std::vector<Listed>& collisions() const { return collisions_; }

  private:
    static std::size_t index(int place) { return static_cast<std::size_t>(place); }

    const Change<Real>* change_at(int change) const {
        return change == Change<Real>::none ? nullptr : &changes_[index(change)];
    }

    void remember(const Collision<Real>& one) {
        const int first = held[index(one.first)].disc;
        const int second = held[index(one.second)].disc;
        const bool counts = first < second ? owns(one.first) : owns(one.second);
        pair_collisions_ += counts && !one.at_wall() ? 1 : 0;
        change(one.first, one.at_wall() ? Change<Real>::wall : second, one.time, one.first_after);
        if (!one.at_wall()) {
            change(one.second, first, one.time, one.second_after);
        }
    }

    void change(int place, int partner, Real time, const BasicDisc<Real>& after) {
        if (kind(place) == Kind::own) {
            own_is_at({after.x, after.y});
            return;
        }
        if (kind(place) == Kind::shared) {
            shared_is_at({after.x, after.y});
        }
        const int added = static_cast<int>(changes_.size());
        int& last = last_[index(place)];
        (last == Change<Real>::none ? first_[index(place)] : changes_[index(last)].next) = added;
        last = added;
        changes_.push_back({time, partner, Change<Real>::none, after});
    }

    void list(const Collision<Real>& one, int first, int second) {
        const bool owns_first = owns(one.first);
        const bool owns_second = owns(one.second);
        if (first <= second) {
            collisions_.push_back(
                {{one.time, 0, first, second, one.first_after, one.second_after}, owns_first, owns_second});
        } else {
            collisions_.push_back(
                {{one.time, 0, second, first, one.second_after, one.first_after}, owns_second, owns_first});
        }
    }

    std::vector<Change<Real>> changes_;
    std::vector<int> first_; ///< of each place's changes
    std::vector<int> last_;
    std::vector<AtWall> at_walls_;
    std::vector<Listed> collisions_;
    Real excursion_ = 0;
    Real clearance_ = 0;
    std::int64_t pair_collisions_ = 0;
};

} // namespace carom
