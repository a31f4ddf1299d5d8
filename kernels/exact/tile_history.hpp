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

    Bounds<Real> bounds; ///< of the tile; infinite beyond the walls
    std::vector<Held> held;
    std::vector<Kind> kinds;                            ///< of each of `held`
    std::vector<int> remembered;                        ///< places of copies and shared discs
    const std::vector<Flight<Real>>* flights = nullptr; ///< of each of `held`, as they are now
    bool ended = true; ///< did the collisions of each instant come to an end?

    /// Forgets the last window. All discs are known. Keeps how they fly now: all at once, if much happened in
    /// the last window, else each when it changes, so that a window in which little happens takes little
    /// time.
    void begin() {
        // Did so many discs collide that to copy all of them in the order of memory takes little time beside?
        const bool much_happened = 4 * told_ >= held.size();
        forget();
        keeps_all_ = much_happened;
        if (keeps_all_) {
            kept_ = *flights;
        }
        first_.resize(held.size(), Change<Real>::none);
        last_.resize(held.size(), Change<Real>::none);
        kept_at_.resize(held.size(), not_kept);
    }

    /// Is told how a disc flies, before that changes.
    void will_change(int place, const Flight<Real>& flight) {
        if (!keeps_all_ && kept_at_[index(place)] == not_kept) {
            kept_at_[index(place)] = static_cast<int>(kept_.size());
            kept_places_.push_back(place);
            kept_.push_back(flight);
        }
    }

    /// Is told every collision in the tile.
    void collided(const Collision<Real>& one) {
        ++told_;
        if (kind(one.first) == Kind::own && kind(one.second) == Kind::own) {
            pair_collisions_ += one.at_wall() ? 0 : 1;
            own_is_at({one.first_after.x, one.first_after.y});
            own_is_at({one.second_after.x, one.second_after.y});
        } else {
            remember(one);
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
    /// The same of all of which nothing else is said.
    void own_are_deeper_than(Real depth) { clearance_ = std::min(clearance_, depth); }
    /// Of one of which there are copies.
    void shared_is_at(const std::array<Real, 2>& point) {
        excursion_ = std::max(excursion_, -bounds.depth(point));
    }

    Kind kind(int place) const { return kinds[index(place)]; }
    bool owns(int place) const { return kind(place) != Kind::copy; }

    /// How a disc flew when the window began.
    const Flight<Real>& began(int place) const {
        const int at = keeps_all_ ? place : kept_at_[index(place)];
        return at == not_kept ? (*flights)[index(place)] : kept_[index(at)];
    }
    /// Lets all fly as they did then.
    void undo(std::vector<Flight<Real>>& now) const {
        if (keeps_all_) {
            now = kept_;
        }
        for (std::size_t at = 0; at < kept_places_.size(); ++at) {
            now[index(kept_places_[at])] = kept_[at];
        }
    }

    const Change<Real>* first(int place) const { return change_at(first_[index(place)]); }
    const Change<Real>* after(const Change<Real>& one) const { return change_at(one.next); }

    /// How far an owned disc of which there are copies came out of the bounds at most.
    Real excursion() const { return excursion_; }
    /// How far inside the bounds every owned disc stayed of which there are none.
    Real clearance() const { return clearance_; }

    /// Of owned discs; those of two tiles count where the disc of the lower number is owned.
    std::int64_t pair_collisions() const { return pair_collisions_; }
    const std::vector<AtWall>& at_walls() const { return at_walls_; }

  private:
    static constexpr int not_kept = -1;

    static std::size_t index(int place) { return static_cast<std::size_t>(place); }

    void forget() {
        for (const int place : changed_) {
            first_[index(place)] = last_[index(place)] = Change<Real>::none;
        }
        for (const int place : kept_places_) {
            kept_at_[index(place)] = not_kept;
        }
        changed_.clear();
        kept_places_.clear();
        kept_.clear();
        changes_.clear();
        at_walls_.clear();
        told_ = 0;
        excursion_ = 0;
        clearance_ = Bounds<Real>::infinity;
        pair_collisions_ = 0;
    }

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
        if (last == Change<Real>::none) {
            first_[index(place)] = added;
            changed_.push_back(place);
        } else {
            changes_[index(last)].next = added;
        }
        last = added;
        changes_.push_back({time, partner, Change<Real>::none, after});
    }

    std::vector<Change<Real>> changes_;
    std::vector<int> first_; ///< of each place's changes
    std::vector<int> last_;
    std::vector<int> changed_; ///< the places that have any
    bool keeps_all_ = false;
    std::vector<Flight<Real>> kept_;
    std::vector<int> kept_places_; ///< of each of kept_, if not all are kept
    std::vector<int> kept_at_;     ///< the inverse
    std::vector<AtWall> at_walls_;
    std::size_t told_ = 0; ///< collisions
    Real excursion_ = 0;
    Real clearance_ = 0;
    std::int64_t pair_collisions_ = 0;
};

} // namespace carom
