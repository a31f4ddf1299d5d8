#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "kernels/exact/event_driven.hpp"
#include "kernels/exact/tile_grid.hpp"
#include "kernels/exact/tile_history.hpp"

namespace carom {

/// A tile of the exact simulation (event_windows.hpp): the discs that it owns, copies of those around it, and
/// what all of these foresee, from window to window. Between windows the tile only puts right what has become
/// wrong: copies that have not gone through the same as their originals, and discs that have come or gone.
///
/// Each function is called for all tiles before the next one is called for any.
template <class Real> class Tile {
  public:
    using Tiles = std::vector<std::unique_ptr<Tile>>;

    /// In a box of that side, with discs of that radius.
    Tile(const TileGrid<Real>& grid, int number, Real box_side, Real radius)
        : grid_(grid), number_(number), radius_(radius), engine_(box_side, radius, Told{&history_}) {
        history_.bounds = grid.bounds(number);
        history_.flights = &engine_.foresight().flights();
    }

    Tile(const Tile&) = delete;
    Tile& operator=(const Tile&) = delete;

    const TileHistory<Real>& history() const { return history_; }
    /// How far it has come.
    Real time() const { return engine_.time(); }

    /// Owns that disc of the scene, too, from the beginning.
    void own(int disc, const Flight<Real>& flight) {
        const int place = static_cast<int>(history_.held.size());
        history_.held.push_back({disc, number_, place});
        history_.kinds.push_back(Kind::own);
        discs().flights().push_back(flight);
        discs().numbers().push_back(disc);
    }

    /// Begins with what it owns and copies of discs as far as `halo` away.
    void begin(Real now, Real halo) {
        const Area<Real> area = grid_.area_around(number_, halo);
        const auto owned = std::ranges::count_if(history_.kinds, [](Kind one) { return one != Kind::copy; });
        const Real with_copies =
            static_cast<Real>(owned) * area.size() / grid_.area_around(number_, 0).size();
        engine_.restart(now, area, static_cast<std::size_t>(with_copies));
        find_near(now, halo);
    }

    /// Lists what it owns and has left it.
    void list_leavers(Real now) {
        leavers_.clear();
        for (const int place : near_) {
            const Flight<Real>& flight = discs().flight(place);
            const std::array<Real, 2> at = position(flight, now);
            if (history_.bounds.depth(at) < 0 && grid_.tile_at(at) != number_) {
                leavers_.push_back({place, grid_.tile_at(at), at, history_.held[index(place)].disc, flight});
            }
        }
    }

    /// Owns what has come from others, gives up what has left, and lists those of its discs of which others
    /// have copies.
    void take_over(const Tiles& tiles, Real now, Real halo) {
        for (const Listed& one : border_) {
            history_.kinds[index(one.place)] = Kind::own;
        }
        for (const Listed& one : leavers_) {
            drop(one.place);
        }
        std::erase_if(near_, [&](int place) { return history_.held[index(place)].disc == Held::nobody; });
        grid_.for_each_near(number_, [&](int other) {
            for (const Listed& one : tiles[index(other)]->leavers_) {
                if (one.to == number_) {
                    const int place = put(one.disc, one.flight, now);
                    history_.held[index(place)] = {one.disc, number_, place};
                    near_.push_back(place);
                }
            }
        });
        std::ranges::sort(near_);
        border_.clear();
        for (const int place : near_) {
            const Flight<Real>& flight = discs().flight(place);
            const std::array<Real, 2> at = position(flight, now);
            const bool shared = history_.bounds.depth(at) <= halo;
            history_.kinds[index(place)] = shared ? Kind::shared : Kind::own;
            if (shared) {
                border_.push_back({place, number_, at, history_.held[index(place)].disc, flight});
            }
        }
    }

    /// Has a copy of each disc within the halo around it, as it is at its owner's, and of no others.
    void hold_copies(const Tiles& tiles, Real now, Real halo) {
        copied_.clear();
        std::size_t next = 0; // of copies_, in the order of their owners and places there
        grid_.for_each_near(number_, [&](int other) {
            for (const Listed& one : tiles[index(other)]->border_) {
                if (other != number_ && history_.bounds.distance(one.at) <= halo) {
                    next = drop_before(next, other, one.place, one.disc);
                    next += copy(next, one, now) ? 1U : 0U;
                }
            }
        });
        drop_before(next, grid_.count(), 0, Held::nobody);
        copies_.swap(copied_);
        discs().look_ahead_of_new(now);
    }

    /// Goes on to `end`, and remembers how it was before and what has happened.
    void simulate(Real end, Real halo, std::int64_t at_once) {
        history_.remembered = copies_;
        for (const Listed& one : border_) {
            history_.remembered.push_back(one.place);
        }
        history_.begin();
        history_.ended = engine_.advance(end, {.at_once = at_once});
        for (const Listed& one : border_) {
            history_.shared_is_at(position(discs().flight(one.place), end));
        }
        find_near(end, halo);
    }

    /// Goes back to where simulate() began.
    void undo(Real now, Real halo) {
        history_.undo(discs().flights());
        begin(now, halo);
    }

    /// `body(disc, flight)` for each disc that it owns.
    template <class Body> void for_each_disc(const Body& body) const {
        for_each_owned(
            [&](int place, const Flight<Real>& flight) { body(history_.held[index(place)].disc, flight); });
    }

  private:
    /// What the engine tells.
    struct Told {
        TileHistory<Real>* history;
        void will_change(int place, const Flight<Real>& flight) { history->will_change(place, flight); }
        void collided(const Collision<Real>& one) { history->collided(one); }
        void met_wall(int place, std::size_t axis, Real velocity) {
            history->met_wall(place, axis, velocity);
        }
    };

    /// An owned disc of which others are to know.
    struct Listed {
        int place;
        int to; ///< the tile that it is in
        std::array<Real, 2> at;
        int disc;
        Flight<Real> flight;
    };

    template <class Body> void for_each_owned(const Body& body) const {
        const std::vector<Flight<Real>>& flights = engine_.foresight().flights();
        for (int place = 0; place < static_cast<int>(flights.size()); ++place) {
            if (history_.owns(place)) {
                body(place, flights[index(place)]);
            }
        }
    }

    /// Finds what it owns near its border or beyond: more than a halo's width inside nothing is shared. It
    /// does not look into cells farther inside, whose discs are so deep, but for what positions are rounded
    /// by.
    void find_near(Real now, Real halo) {
        near_.clear();
        const auto look_at = [&](int place) {
            if (!history_.owns(place)) {
                return;
            }
            const std::array<Real, 2> at = position(discs().flight(place), now);
            if (history_.kind(place) == Kind::own) {
                history_.own_is_at(at);
            }
            if (history_.bounds.depth(at) <= halo) {
                near_.push_back(place);
            }
        };
        history_.own_are_deeper_than(halo + 3 * radius_);
        discs().for_each_outside(history_.bounds.shrunk(halo + 4 * radius_), look_at);
    }

    Foresight<Real>& discs() { return engine_.foresight(); }

    int put(int disc, const Flight<Real>& flight, Real now) {
        const int place = discs().add(flight, disc, now);
        if (index(place) == history_.held.size()) {
            history_.held.emplace_back();
            history_.kinds.emplace_back();
        }
        return place;
    }

    void drop(int place) {
        discs().remove(place);
        history_.held[index(place)] = {};
        history_.kinds[index(place)] = Kind::copy;
    }

    /// Drops copies of discs that their owners no longer list, up to that of a disc at a place of its owner.
    std::size_t drop_before(std::size_t next, int owner, int place, int disc) {
        const auto is_before = [&](const Held& one) {
            return std::tie(one.owner, one.place) < std::tie(owner, place) ||
                   (one.owner == owner && one.place == place && one.disc != disc);
        };
        for (; next < copies_.size() && is_before(history_.held[index(copies_[next])]); ++next) {
            drop(copies_[next]);
        }
        return next;
    }

    /// Has a copy of a listed disc. True if the next of copies_ is it.
    bool copy(std::size_t next, const Listed& one, Real now) {
        const Held wanted{one.disc, one.to, one.place};
        const bool is_there = next < copies_.size() && history_.held[index(copies_[next])] == wanted;
        const int place = is_there ? copies_[next] : put(one.disc, one.flight, now);
        if (is_there && !discs().flight(place).is_as(one.flight)) {
            discs().replace(place, one.flight, now);
        }
        history_.held[index(place)] = wanted;
        history_.kinds[index(place)] = Kind::copy;
        copied_.push_back(place);
        return is_there;
    }

    static std::size_t index(int i) { return static_cast<std::size_t>(i); }

    const TileGrid<Real>& grid_;
    int number_;
    Real radius_; ///< of the discs
    TileHistory<Real> history_;
    EventDriven<Real, Told> engine_;
    std::vector<int> near_; ///< places of owned discs that may have left it or be shared
    std::vector<Listed> leavers_;
    std::vector<Listed> border_; ///< by place
    std::vector<int> copies_;    ///< places of copies, by their owners and places there
    std::vector<int> copied_;    ///< the same of the next window
};

} // namespace carom
