#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <vector>

#include "kernels/exact/agreement.hpp"
#include "kernels/exact/event_driven.hpp"
#include "kernels/exact/tile_grid.hpp"
#include "kernels/exact/tile_history.hpp"
#include "kernels/parallel_for.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// How the event-driven simulation shares a scene out. No result depends on it.
struct WindowSettings {
    int tiles_per_side = 1;
    double halo = 18;                  ///< how far from a tile discs are copied, in radii, at first
    double collisions_per_disc = 2;    ///< of a window
    double widen = 1.3;                ///< the halo by that, when tiles disagree
    double narrow = 0.995;             ///< and by that, down to a third, when they agree
    int most_repetitions = 6;          ///< of a window in tiles; then it is done in one
    std::int64_t at_once = 10'000'000; ///< events of one instant in a tile
};

/// Into how many tiles a side a scene of so many discs is cut for that many threads; 1 where the simulation
/// in one piece takes less time. Every disc is looked up anew when a window begins, and copies are simulated
/// twice, so that each thread does about half of what it would do alone (docs/performance.md): two of them
/// gain nothing.
inline int tiles_per_side(std::size_t discs, int threads) {
    constexpr int least_threads = 4;
    constexpr double least_discs = 2'000;   // of a tile: of fewer, most have copies
    constexpr double cached_discs = 12'000; // with all that belongs to them some 1.5 MB, a second cache
    const auto count = static_cast<double>(discs);
    const double wanted = std::max(std::sqrt(count / cached_discs), std::sqrt(2.0 * threads));
    const double most = std::floor(std::sqrt(count / least_discs));
    return threads < least_threads || most < 3 ? 1 : static_cast<int>(std::min(std::ceil(wanted), most));
}

/// The event-driven simulation on several threads, to the same bits as on one (event_driven.hpp).
///
/// Space is cut into tiles and time into windows. In a window each tile simulates by itself the discs that it
/// owns, which are in it at the beginning, and copies of those around it, within the halo. Then the tiles are
/// held against each other; if they agree, what the owners say is the true run (agreement.hpp). If not, the
/// window is done again from its beginning, with half the time and a wider halo, and at last in a single
/// tile. How long windows are is decided by counts, never by a clock.
///
/// A window is short, a few collisions a disc, since what is wrong at the edge of the halo spreads inwards no
/// faster than collisions hand it on. A tile is small enough to stay in a processor's cache for all of a
/// window, which on large scenes is worth more than what copies cost.
template <class Real> class EventWindows {
  public:
    EventWindows(const Scene& scene, int threads, const WindowSettings& settings)
        : settings_(settings), threads_(threads), side_(static_cast<Real>(scene.side)),
          radius_(static_cast<Real>(scene.radius)), grid_(side_, settings.tiles_per_side) {
        for (int thread = 0; thread < threads; ++thread) {
            workers_.push_back(std::make_unique<Worker>(side_, radius_));
        }
        restart(scene);
    }

    /// Goes back to the start of a scene with the same box.
    void restart(const Scene& scene) {
        begin_flights(scene, flights_);
        after_.resize(flights_.size());
        tile_of_.resize(flights_.size());
        place_.resize(flights_.size());
        listed_.resize(flights_.size());
        now_ = 0;
        pair_collisions_ = wall_collisions_ = windows_ = repeated_ = 0;
        halo_ = static_cast<Real>(settings_.halo) * radius_;
        window_ = first_window(scene);
        cut(settings_.tiles_per_side);
    }

    /// Goes on to `time`. False if the collisions of one instant do not come to an end.
    bool advance(Real time) {
        do {
            if (!next_window(time)) {
                return false;
            }
        } while (now_ < time);
        return true;
    }

    /// The discs as they are now, disc i at index i.
    std::vector<BasicDisc<Real>> discs() const {
        std::vector<BasicDisc<Real>> result;
        result.reserve(flights_.size());
        for (const Flight<Real>& one : flights_) {
            const auto [x, y] = position(one, now_);
            result.push_back({x, y, one.vx, one.vy});
        }
        return result;
    }

    Real time() const { return now_; }
    std::int64_t pair_collisions() const { return pair_collisions_; }
    std::int64_t wall_collisions() const { return wall_collisions_; }

    /// Windows so far, and how often one had to be done again.
    std::int64_t windows() const { return windows_; }
    std::int64_t repeated() const { return repeated_; }

  private:
    /// Passes on what an engine tells to the tile that it is at.
    struct ToTile {
        TileHistory<Real>** tile = nullptr;
        void collided(const Collision<Real>& one) { (*tile)->collided(one); }
    };

    /// What a thread simulates tiles with.
    struct Worker {
        Worker(Real side, Real radius) : engine(side, radius, ToTile{&tile}) {}
        TileHistory<Real>* tile = nullptr;
        EventDriven<Real, ToTile> engine;
        std::vector<Flight<Real>> flights;
    };

    /// A disc, and where it is when a window begins.
    struct Listed {
        int disc;
        std::array<Real, 2> at;
    };

    /// One window, until `time` at most, again and again until the tiles agree; at last in one tile.
    bool next_window(Real time) {
        for (int repetition = 0; repetition < settings_.most_repetitions; ++repetition) {
            const Real end = end_of_window(time);
            if (simulate(end)) {
                const auto least = static_cast<Real>(settings_.halo / 3) * radius_;
                halo_ = std::max(halo_ * static_cast<Real>(settings_.narrow), least);
                accept(end);
                return true;
            }
            ++repeated_;
            window_ = (end - now_) / 2;
            halo_ = std::min(halo_ * static_cast<Real>(settings_.widen), grid_.tile_side());
        }
        cut(1);
        const Real end = end_of_window(time);
        const bool ended = simulate(end);
        if (ended) {
            accept(end);
        }
        cut(settings_.tiles_per_side);
        return ended;
    }

    /// Of windows of one length, as many as it takes until `time`.
    Real end_of_window(Real time) const {
        const Real windows = std::ceil((time - now_) / window_);
        const Real end = windows > 1 ? now_ + (time - now_) / windows : time;
        return end > now_ ? std::min(end, time) : time;
    }

    /// Every tile by itself, then whether they agree: if not, nothing has changed.
    bool simulate(Real end) {
        share_discs();
        for_each_tile([&](int tile) {
            hold_discs(tile);
            simulate_tile(tile, end);
        });
        const Window<Real> window{.begin = now_,
                                  .end = end,
                                  .halo = halo_,
                                  .grid = grid_,
                                  .tiles = tiles_,
                                  .flights = flights_,
                                  .tile_of = tile_of_,
                                  .place = place_};
        const Agreement<Real> agreement(window, radius_);
        for_each_tile([&](int tile) { agreed_[index(tile)] = agreement.of(tile) ? 1 : 0; });
        return std::ranges::all_of(agreed_, [](char one) { return one != 0; });
    }

    /// What the owners say holds.
    void accept(Real end) {
        flights_.swap(after_);
        std::int64_t pairs = 0;
        for (const TileHistory<Real>& tile : tiles_) {
            pairs += tile.pair_collisions();
            wall_collisions_ += tile.wall_collisions();
        }
        pair_collisions_ += pairs;
        ++windows_;
        if (end - now_ >= window_ / 2) { // a shorter one says little
            const Real per_disc = 2 * static_cast<Real>(pairs) / static_cast<Real>(flights_.size() + 1);
            const Real wanted = static_cast<Real>(settings_.collisions_per_disc);
            window_ *= per_disc > 0 ? std::clamp(wanted / per_disc, Real(0.5), Real(2)) : Real(2);
        }
        now_ = end;
    }

    /// Cuts the box into so many tiles a side.
    void cut(int tiles_per_side) {
        grid_ = TileGrid<Real>(side_, tiles_per_side);
        tiles_.resize(index(grid_.count()));
        agreed_.resize(index(grid_.count()));
        for (int tile = 0; tile < grid_.count(); ++tile) {
            tiles_[index(tile)].bounds = grid_.bounds(tile);
        }
    }

    /// Tells each disc's tile, and lists the discs by their tiles.
    void share_discs() {
        const int count = static_cast<int>(flights_.size());
        parallel_for<Schedule::static_>(threads_, count, 1, no_probe_, [&](int i) {
            tile_of_[index(i)] = grid_.tile_at(position(flights_[index(i)], now_));
        });
        begin_.assign(tiles_.size() + 1, 0);
        for (const int tile : tile_of_) {
            ++begin_[index(tile) + 1];
        }
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        next_.assign(begin_.begin(), begin_.end() - 1);
        for (int i = 0; i < count; ++i) {
            int& next = next_[index(tile_of_[index(i)])];
            listed_[index(next)] = {i, position(flights_[index(i)], now_)};
            ++next;
        }
    }

    /// Gives a tile its own discs, and copies of those in the halo.
    void hold_discs(int number) {
        TileHistory<Real>& tile = tiles_[index(number)];
        tile.held.clear();
        grid_.for_each_near(number, [&](int other) {
            for (int k = begin_[index(other)]; k < begin_[index(other) + 1]; ++k) {
                const auto& [disc, at] = listed_[index(k)];
                if (other == number) {
                    tile.held.push_back({disc, true, tile.bounds.depth(at) <= halo_});
                } else if (tile.bounds.distance(at) <= halo_) {
                    tile.held.push_back({disc, false, true});
                }
            }
        });
        std::ranges::sort(tile.held, {}, &Held::disc);
        tile.begin();
    }

    /// Simulates a tile up to `end`, and notes where what it owns is then.
    void simulate_tile(int number, Real end) {
        TileHistory<Real>& tile = tiles_[index(number)];
        auto& [at, engine, flights] = *workers_[index(this_thread())];
        at = &tile;
        flights.clear();
        for (const Held& one : tile.held) {
            flights.push_back(flights_[index(one.disc)]);
        }
        engine.restart(flights, now_, grid_.square_around(number, halo_));
        tile.ended = engine.advance(end, {.at_once = settings_.at_once});
        for (int k = 0; k < static_cast<int>(tile.held.size()); ++k) {
            if (tile.held[index(k)].owned) {
                const std::size_t disc = index(tile.held[index(k)].disc);
                after_[disc] = engine.flights()[index(k)];
                place_[disc] = k;
                tile.owned_is_at(k, position(after_[disc], end));
            }
        }
    }

    template <class Body> void for_each_tile(const Body& body) {
        parallel_for<Schedule::dynamic>(threads_, grid_.count(), 1, no_probe_, body);
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
    Real side_; ///< of the box
    Real radius_;
    Real now_ = 0;
    Real halo_ = 0;
    Real window_ = 0; ///< how long the next one is to be
    TileGrid<Real> grid_;
    std::vector<TileHistory<Real>> tiles_;
    std::vector<char> agreed_;                     ///< of each tile
    std::vector<std::unique_ptr<Worker>> workers_; ///< one a thread
    std::vector<Flight<Real>> flights_;            ///< of each disc, when a window begins
    std::vector<Flight<Real>> after_;              ///< when it ends
    std::vector<int> tile_of_;                     ///< of each disc
    std::vector<int> place_;                       ///< of each disc, among those of its tile
    std::vector<Listed> listed_;                   ///< by tile
    std::vector<int> begin_;                       ///< of each tile's discs in listed_
    std::vector<int> next_;
    std::int64_t pair_collisions_ = 0;
    std::int64_t wall_collisions_ = 0;
    std::int64_t windows_ = 0;
    std::int64_t repeated_ = 0;
    NoProbe no_probe_;
};

} // namespace carom
