#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/exact/event_cells.hpp"
#include "kernels/exact/event_queue.hpp"
#include "kernels/exact/first_collision.hpp"
#include "kernels/exact/flight.hpp"
#include "kernels/exact/prefetch_events.hpp"

namespace carom {

/// The discs of the exact simulation, which of them are near each other, and the next event that each
/// foresees: its first collision, or that it crosses into another cell before. Discs look into the nine cells
/// around them.
///
/// A disc is told by its place. Where the discs are only some of a scene's (tile.hpp) it has a number beside,
/// by which collisions of one instant are ordered. That a disc has been taken out or flies otherwise is
/// noticed by who has foreseen it: its age has changed.
template <class Real> class Foresight {
  public:
    /// What Flight says of its partner: a wall across x or y.
    static constexpr int wall_x = -2;
    static constexpr int wall_y = -3;

    Foresight(Real side, Real radius) : walls_{radius, side - radius}, reach_squared_(4 * radius * radius) {}

    /// The flights, for begin().
    std::vector<Flight<Real>>& flights() { return flights_; }
    const std::vector<Flight<Real>>& flights() const { return flights_; }
    Flight<Real>& flight(int place) { return flights_[index(place)]; }

    /// The numbers of the discs, for begin(): none where they are the places; below 0 where no disc is.
    std::vector<int>& numbers() { return numbers_; }

    /// Begins with the flights that are there. The area, with so many discs expected in it, gets about a cell
    /// a disc, and so many cells a side at most.
    void begin(Real now, const Area<Real>& area, std::size_t expected, int most_cells_per_side) {
        const int count = static_cast<int>(flights_.size());
        free_.clear();
        new_.clear();
        cells_.arrange(area, expected, walls_[0], most_cells_per_side);
        cells_.hold(flights_.size());
        nine_ = cells_.nine();
        queue_.clear(count);
        queue_.number(numbers_);
        for (int place = 0; place < count; ++place) {
            if (numbers_.empty() || numbers_[index(place)] != nobody) {
                put_into_cell(place, now);
            } else {
                free_.push_back(place);
            }
        }
        look_ahead_of_new(now);
    }

    /// Puts another disc of that number in and tells its place. It does not look ahead yet.
    int add(const Flight<Real>& other, int number, Real now) {
        if (free_.empty()) {
            free_.push_back(static_cast<int>(flights_.size()));
            flights_.emplace_back();
            numbers_.push_back(nobody);
            cells_.hold(flights_.size());
        }
        const int place = free_.back();
        free_.pop_back();
        numbers_[index(place)] = number;
        queue_.number(numbers_);
        put(place, other, now);
        return place;
    }

    /// Takes the disc at that place out.
    void remove(int place) {
        take_out(place);
        numbers_[index(place)] = nobody;
        queue_.set(place, never, nobody);
        free_.push_back(place);
    }

    /// Lets the disc at that place fly otherwise. It does not look ahead yet.
    void replace(int place, const Flight<Real>& other, Real now) {
        take_out(place);
        put(place, other, now);
    }

    /// Looks ahead for all that have been put in or replaced.
    void look_ahead_of_new(Real now) {
        for (const int place : new_) {
            look_ahead(place, now);
        }
        new_.clear();
    }

    /// `body(place)` for each disc in a cell that is not wholly inside a rectangle.
    template <class Body> void for_each_outside(const Bounds<Real>& inside, const Body& body) const {
        cells_.for_each_disc_outside(inside, body);
    }

    /// When the next event of all is; infinity if there is none.
    Real earliest_time() { return queue_.earliest_time(); }
    /// The disc of that event.
    int earliest() const { return queue_.earliest(); }

    /// Asks the memory for what comes next, where the discs fill more than a cache. Not inlined, g++ takes it
    /// for a function that does nothing and leaves the call out.
    [[gnu::always_inline]] void prefetch() const {
        constexpr std::size_t at_hand = 4096; // 256 KiB, which a second cache holds
        if (flights_.size() > at_hand) {
            PrefetchEvents<Real>(flights_, cells_, nine_).what_comes(queue_);
        }
    }

    /// Foresees the next event of a disc from nothing.
    void look_ahead(int place, Real now) {
        Flight<Real>& one = flight(place);
        one.collision_time = never;
        one.partner = nobody;
        foresee_wall(one, one.x, one.vx, wall_x);
        foresee_wall(one, one.y, one.vy, wall_y);
        FirstCollision<Real> first(flights_, cells_, numbers_, place, reach_squared_);
        for (const int offset : nine_) {
            first.look_into(one.cell + offset);
        }
        if (one.time == now) {
            first.template foresee<true>();
        } else {
            first.foresee();
        }
        schedule(place);
    }

    /// Puts a disc that is at the edge of its cell into the next one and looks into the cells that came into
    /// reach.
    void cross(int place) {
        Flight<Real>& one = flight(place);
        const bool in_y = time_to_crossing_y(one) < time_to_crossing_x(one);
        const int across = in_y ? 1 : cells_.stride();
        const int along = in_y ? cells_.stride() : 1;
        const int step = (in_y ? one.vy : one.vx) > 0 ? along : -along;
        cells_.remove(place, one.cell);
        one.cell += step;
        cells_.insert(place, one.cell);
        FirstCollision<Real> first(flights_, cells_, numbers_, place, reach_squared_);
        for (const int offset : {step - across, step, step + across}) {
            first.look_into(one.cell + offset);
        }
        first.foresee();
        schedule(place);
    }

  private:
    static constexpr int nobody = Flight<Real>::nobody;
    static constexpr Real never = std::numeric_limits<Real>::infinity();

    static std::size_t index(int place) { return static_cast<std::size_t>(place); }

    void put(int place, const Flight<Real>& other, Real now) {
        const std::uint32_t age = flight(place).age;
        flight(place) = other;
        flight(place).age = age;
        put_into_cell(place, now);
    }

    void put_into_cell(int place, Real now) {
        Flight<Real>& one = flight(place);
        const Real elapsed = now - one.time;
        one.cell = cells_.cell_at(one.x + one.vx * elapsed, one.y + one.vy * elapsed);
        cells_.insert(place, one.cell);
        new_.push_back(place);
    }

    void take_out(int place) {
        ++flight(place).age;
        cells_.remove(place, flight(place).cell);
    }

    void foresee_wall(Flight<Real>& one, Real position, Real velocity, int wall) const {
        const Real time = one.time + time_to(walls_[velocity > 0 ? 1 : 0], position, velocity);
        one.partner = time < one.collision_time ? wall : one.partner;
        one.collision_time = std::min(one.collision_time, time);
    }

    /// How long until a disc is there along an axis, which it flies towards; at once if it is beyond.
    static Real time_to(Real target, Real position, Real velocity) {
        return velocity == 0 ? never : std::max((target - position) / velocity, Real(0));
    }

    Real time_to_crossing_x(const Flight<Real>& one) const {
        return time_to(cells_.edge_x(one.cell, one.vx > 0), one.x, one.vx);
    }

    Real time_to_crossing_y(const Flight<Real>& one) const {
        return time_to(cells_.edge_y(one.cell, one.vy > 0), one.y, one.vy);
    }

    void schedule(int place) {
        const Flight<Real>& one = flight(place);
        const Real crossing_time = one.time + std::min(time_to_crossing_x(one), time_to_crossing_y(one));
        const bool crosses = crossing_time < one.collision_time;
        queue_.set(place, crosses ? crossing_time : one.collision_time, crosses ? nobody : one.beside(place));
    }

    std::array<Real, 2> walls_; ///< how far a centre comes, down and up
    Real reach_squared_;        ///< (2r)^2
    std::vector<Flight<Real>> flights_;
    std::vector<int> numbers_;
    std::vector<int> free_; ///< places without a disc
    std::vector<int> new_;  ///< places of discs that have not looked ahead
    EventCells<Real> cells_;
    std::array<int, 9> nine_{};
    EventQueue<Real> queue_;
};

} // namespace carom
