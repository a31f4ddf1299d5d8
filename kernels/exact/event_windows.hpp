#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/exact/agreement.hpp"
#include "kernels/exact/memory_order.hpp"
#include "kernels/exact/tile.hpp"
#include "kernels/exact/tile_grid.hpp"
#include "kernels/exact/wall_sums.hpp"
#include "kernels/parallel_for.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// How the event-driven simulation shares a scene out. No result depends on it.
struct WindowSettings {
    TileCounts tiles = {};
    double halo = 12;               ///< how far from a tile discs are copied at first, in radii,
    double halo_paths = 4;          ///< and so many mean free paths more
    double collisions_per_disc = 1; ///< of a window
    double widen = 1.3;             ///< the halo by that, when tiles disagree
    double narrow = 0.998;          ///< and by that, down to a third, when they agree
    int most_repetitions = 6;       ///< of a window in tiles; then it is done in one
};

/// The event-driven simulation on several threads, to the same bits as on one (event_driven.hpp).
///
/// Space is cut into tiles and time into windows. In a window each tile simulates by itself the discs that it
/// owns, which are in it at the beginning, and copies of those around it, within the halo. Then the tiles are
/// held against each other; if they agree, what the owners say is the true run (agreement.hpp). If not, the
/// window is done again from its beginning, with half the time and a wider halo, and at last in a single
/// tile. How long windows are is decided by counts, never by a clock.
///
/// A window is short, one collision a disc, since what is wrong at the edge of the halo spreads inwards no
/// faster than collisions hand it on. A tile is small enough to stay in a processor's cache for all of a
/// window, which on large scenes is worth more than what copies cost.
template <class Real> class EventWindows {
  public:
    EventWindows(const Scene& scene, int threads, const WindowSettings& settings)
        : settings_(settings), threads_(threads), side_(static_cast<Real>(scene.side)),
          radius_(static_cast<Real>(scene.radius)), grid_(side_, settings.tiles) {
        restart(scene);
    }

    /// Goes back to the start of a scene with the same box.
    void restart(const Scene& scene) {
        count_ = scene.discs.size();
        now_ = stuck_at_ = 0;
        pair_collisions_ = wall_collisions_ = windows_ = repeated_ = 0;
        wall_sums_.clear(count_);
        first_halo_ = first_halo(scene);
        halo_ = first_halo_;
        window_ = first_window(scene);
        std::vector<Flight<Real>> flights;
        begin_flights(scene, flights);
        cut(settings_.tiles, flights);
    }

    /// Goes on to `time`. False if a limit is passed, of the events of one instant in a tile or of collisions
    /// in all: it then stands at that instant, or soon after the limit.
    bool advance(Real time, const EventLimits& limits = {}) {
        at_once_ = limits.at_once;
        do {
            if (!next_window(time) || pair_collisions_ + wall_collisions_ > limits.in_all) {
                return false;
            }
        } while (now_ < time);
        return true;
    }

    /// The discs as they are now, disc i at index i.
    std::vector<BasicDisc<Real>> discs() const {
        std::vector<BasicDisc<Real>> result(count_);
        for_each_disc([&](int disc, const Flight<Real>& one) {
            const auto [x, y] = position(one, now_);
            result[index(disc)] = {x, y, one.vx, one.vy};
        });
        return result;
    }

    Real time() const { return std::max(now_, stuck_at_); }
    std::int64_t pair_collisions() const { return pair_collisions_; }
    std::int64_t wall_collisions() const { return wall_collisions_; }
    /// As of EventDriven, to the same bits.
    Real wall_impulse() const { return wall_sums_.impulse(); }
    std::array<Real, 2> momentum_from_walls() const { return wall_sums_.momentum(); }

    /// Windows so far, and how often one had to be done again.
    std::int64_t windows() const { return windows_; }
    std::int64_t repeated() const { return repeated_; }

  private:
    /// One window, until `time` at most, again and again until the tiles agree; at last in one tile.
    bool next_window(Real time) {
        const Real wanted = window_;
        for (int repetition = 0; repetition < settings_.most_repetitions; ++repetition) {
            const Real end = end_of_window(time);
            if (simulate(end)) {
                halo_ = std::max(halo_ * static_cast<Real>(settings_.narrow), first_halo_ / 3);
                accept(end);
                return true;
            }
            ++repeated_;
            window_ = (end - now_) / 2;
            halo_ = std::min(halo_ * static_cast<Real>(settings_.widen), grid_.least_side());
            for_each_tile([&](Tile<Real>& tile) { tile.undo(now_, halo_); });
        }
        window_ = wanted;
        cut({}, flights());
        const Real end = end_of_window(time);
        const bool ended = simulate(end);
        stuck_at_ = tiles_.front()->time();
        if (ended) {
            accept(end);
        }
        cut(settings_.tiles, flights());
        return ended;
    }

    /// Of windows of one length, as many as it takes until `time`.
    Real end_of_window(Real time) const {
        const Real windows = std::ceil((time - now_) / window_);
        const Real end = windows > 1 ? now_ + (time - now_) / windows : time;
        return end > now_ ? std::min(end, time) : time;
    }

    /// Every tile by itself, then whether they agree: what they say holds only if they do.
    bool simulate(Real end) {
        for_each_tile([&](Tile<Real>& tile) { tile.list_leavers(now_); });
        for_each_tile([&](Tile<Real>& tile) { tile.take_over(tiles_, now_, halo_); });
        for_each_tile([&](Tile<Real>& tile) {
            tile.hold_copies(tiles_, now_, halo_);
            tile.simulate(end, halo_, at_once_);
        });
        Window<Real> window{.begin = now_, .end = end, .halo = halo_, .grid = grid_, .tiles = {}};
        for (const auto& tile : tiles_) {
            window.tiles.push_back(&tile->history());
        }
        const Agreement<Real> agreement(window, radius_);
        for_each_number([&](int tile) { agreed_[index(tile)] = agreement.of(tile) ? 1 : 0; });
        return std::ranges::all_of(agreed_, [](char one) { return one != 0; });
    }

    /// What the owners say holds.
    void accept(Real end) {
        std::int64_t pairs = 0;
        for (const auto& tile : tiles_) {
            pairs += tile->history().pair_collisions();
            for (const auto& [disc, axis, velocity] : tile->history().at_walls()) {
                wall_sums_.add(disc, axis, velocity);
                ++wall_collisions_;
            }
        }
        pair_collisions_ += pairs;
        ++windows_;
        if (end - now_ >= window_ / 2) { // a shorter one says little
            const Real per_disc = 2 * static_cast<Real>(pairs) / static_cast<Real>(count_ + 1);
            const Real wanted = static_cast<Real>(settings_.collisions_per_disc);
            window_ *= per_disc > 0 ? std::clamp(wanted / per_disc, Real(0.5), Real(1.5)) : Real(1.5);
        }
        now_ = end;
    }

    /// Cuts the box into so many tiles, which own discs with these flights, near each other in memory as they
    /// are in space.
    void cut(const TileCounts& tiles, const std::vector<Flight<Real>>& flights) {
        tiles_.clear();
        grid_ = TileGrid<Real>(side_, tiles);
        agreed_.assign(index(grid_.count()), 0);
        for (int tile = 0; tile < grid_.count(); ++tile) {
            tiles_.push_back(std::make_unique<Tile<Real>>(grid_, tile, side_, radius_));
        }
        for (const int disc : memory_order(flights, now_, side_)) {
            const Flight<Real>& one = flights[index(disc)];
            tiles_[index(grid_.tile_at(position(one, now_)))]->own(disc, one);
        }
        for_each_tile([&](Tile<Real>& tile) { tile.begin(now_, halo_); });
    }

    std::vector<Flight<Real>> flights() const {
        std::vector<Flight<Real>> result(count_);
        for_each_disc([&](int disc, const Flight<Real>& one) { result[index(disc)] = one; });
        return result;
    }

    template <class Body> void for_each_disc(const Body& body) const {
        for (const auto& tile : tiles_) {
            tile->for_each_disc(body);
        }
    }

    template <class Body> void for_each_tile(const Body& body) {
        for_each_number([&](int tile) { body(*tiles_[index(tile)]); });
    }

    /// `body(tile)` for the number of each tile. Where there is a thread for each, it is always the same one,
    /// whose cache the tile is in.
    template <class Body> void for_each_number(const Body& body) {
        const int count = grid_.count();
        if (count <= threads_) {
            parallel_for<Schedule::static_>(count, count, 1, no_probe_, body);
        } else {
            parallel_for<Schedule::dynamic>(threads_, count, 1, no_probe_, body);
        }
    }

    /// In a window what is wrong at the edge comes the farther the farther discs fly between collisions. The
    /// mean free path in a dilute gas of discs of diameter d, n of them an area, is 1 / (sqrt(8) d n).
    Real first_halo(const Scene& scene) const {
        const double discs = static_cast<double>(scene.discs.size()) / scene.side / scene.side;
        const double path = 1 / (std::sqrt(8.0) * 2 * scene.radius * discs);
        const auto halo =
            static_cast<Real>(settings_.halo * scene.radius + (discs > 0 ? settings_.halo_paths * path : 0));
        return std::min(halo, grid_.least_side());
    }

    /// Until a disc of root mean square speed has flown half a radius.
    Real first_window(const Scene& scene) const {
        double squares = 0;
        for (const Disc& disc : scene.discs) {
            squares += disc.vx * disc.vx + disc.vy * disc.vy;
        }
        const double speed = std::sqrt(squares / (static_cast<double>(scene.discs.size()) + 1));
        return speed > 0 ? static_cast<Real>(scene.radius / 2 / speed) : Real(1);
    }

    static std::size_t index(int i) { return static_cast<std::size_t>(i); }

    WindowSettings settings_;
    int threads_;
    std::size_t count_ = 0; ///< of discs
    Real side_;             ///< of the box
    Real radius_;
    Real now_ = 0;
    Real stuck_at_ = 0; ///< where a window in one tile has ended
    Real first_halo_ = 0;
    Real halo_ = 0;
    std::int64_t at_once_ = 0; ///< events, at most
    Real window_ = 0;          ///< how long the next one is to be
    TileGrid<Real> grid_;
    typename Tile<Real>::Tiles tiles_;
    std::vector<char> agreed_; ///< of each tile
    std::int64_t pair_collisions_ = 0;
    std::int64_t wall_collisions_ = 0;
    WallSums<Real> wall_sums_;
    std::int64_t windows_ = 0;
    std::int64_t repeated_ = 0;
    NoProbe no_probe_;
};

} // namespace carom
