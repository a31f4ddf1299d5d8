#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "kernels/exact/flight.hpp"
#include "kernels/exact/tile_grid.hpp"
#include "kernels/exact/tile_history.hpp"

namespace carom {

/// A window, and what the tiles have come to in it.
template <class Real> struct Window {
    Real begin;
    Real end;
    Real halo; ///< how far from its bounds a tile has copies
    const TileGrid<Real>& grid;
    std::vector<const TileHistory<Real>*> tiles;
};

/// Whether what the owners say is what truly happens, as far as one tile has to see to it. They agree if
///
///  1. each copy that the tile has went through the same collisions, to the bit, as the disc at its owner's,
///  or
///     at least up to a time from which on neither of the two comes near what the tile owns;
///  2. nothing that the tile owns comes near what another tile owns that has no copy of it.
///
/// If all tiles agree, all owners tell the truth. For suppose that they do before time t, and one of them, A,
/// does not at t, of a disc that it owns. Before t the disc is where A has it. Whatever collides with it at
/// t, truly or in A alone, is within 2r of it then. So A owns that, too, or has a copy of it, by 2, which
/// went through the same as at its owner's before t, by 1, and so through what is true. Then A had the true
/// flights of both. They alone decide whether and when they collide (first_collision.hpp), so that A is right
/// at t.
///
/// `radius` is that of the discs. Distances are along the axis along which they are greater.
template <class Real> class Agreement {
  public:
    Agreement(const Window<Real>& window, Real radius) : window_(window), near_(Real(2.001) * radius) {}

    bool of(int number) const {
        const TileHistory<Real>& tile = of_tile(number);
        Real farthest = 0;
        window_.grid.for_each_near(
            number, [&](int other) { farthest = std::max(farthest, of_tile(other).excursion()); });
        // Those farther away than the tiles around it have no copies of what it owns.
        const bool agreed = tile.ended && tile.clearance() > farthest + near_ &&
                            2 * tile.excursion() + near_ < window_.grid.least_side();
        return agreed && std::ranges::all_of(tile.remembered, [&](int place) {
                   return tile.owns(place) ? stays_away(number, place, farthest) : is_as_owned(tile, place);
               });
    }

  private:
    /// Does an owned disc keep away from what the tiles around own that have no copy of it? That of them
    /// which came out of its bounds farthest came so far.
    bool stays_away(int number, int place, Real farthest) const {
        const TileHistory<Real>& tile = of_tile(number);
        const Flight<Real>& before = tile.began(place);
        const std::array<Real, 2> start = position(before, window_.begin);
        const Bounds<Real> flown = path(tile, before, tile.first(place), window_.begin);
        if (tile.bounds.depth(flown) > farthest + near_) {
            return true;
        }
        bool away = true;
        window_.grid.for_each_near(number, [&](int other) {
            const TileHistory<Real>& around = of_tile(other);
            if (other != number && around.bounds.distance(start) > window_.halo) {
                away = away && flown.distance(around.bounds) > around.excursion() + near_;
            }
        });
        return away;
    }

    /// Has a copy the same history as the disc at its owner's, as long as it matters?
    bool is_as_owned(const TileHistory<Real>& tile, int place) const {
        const Held& held = tile.held[index(place)];
        const TileHistory<Real>& owner = of_tile(held.owner);
        Flight<Real> flight = tile.began(place);
        const Change<Real>* copied = tile.first(place);
        const Change<Real>* owned = owner.first(held.place);
        while (copied != nullptr && owned != nullptr && copied->is_as(*owned)) {
            flight = flight_after(*copied);
            copied = tile.after(*copied);
            owned = owner.after(*owned);
        }
        if (copied == nullptr && owned == nullptr) {
            return true;
        }
        const Real parted = std::min(copied != nullptr ? copied->time : window_.end,
                                     owned != nullptr ? owned->time : window_.end);
        const Real reach = tile.excursion() + near_;
        return path(tile, flight, copied, parted).distance(tile.bounds) > reach &&
               path(owner, flight, owned, parted).distance(tile.bounds) > reach;
    }

    /// What holds a disc from a time to the end of the window that flies so until that change.
    Bounds<Real> path(const TileHistory<Real>& tile, Flight<Real> flight, const Change<Real>* change,
                      Real from) const {
        Bounds<Real> bounds;
        bounds.widen(position(flight, from));
        for (; change != nullptr; change = tile.after(*change)) {
            flight = flight_after(*change);
            bounds.widen({flight.x, flight.y});
        }
        bounds.widen(position(flight, window_.end));
        return bounds;
    }

    static Flight<Real> flight_after(const Change<Real>& one) {
        return {.x = one.after.x, .y = one.after.y, .vx = one.after.vx, .vy = one.after.vy, .time = one.time};
    }

    const TileHistory<Real>& of_tile(int number) const { return *window_.tiles[index(number)]; }

    static std::size_t index(int i) { return static_cast<std::size_t>(i); }

    const Window<Real>& window_;
    Real near_; ///< 2r, and what positions are rounded by
};

} // namespace carom
