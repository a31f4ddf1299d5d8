#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/exact/event_driven.hpp"
#include "kernels/exact/event_windows.hpp"
#include "kernels/exact/tiles_for.hpp"
#include "kernels/probe.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// The exact simulation of a scene on so many threads at most: in one piece (event_driven.hpp) or in tiles
/// (event_windows.hpp), whichever takes less time. No result depends on which, nor on the threads.
template <class Real> class ExactSimulation {
  public:
    ExactSimulation(const Scene& scene, int threads) {
        const TileCounts tiles = tiles_for(scene.discs.size(), threads);
        if (tiles.all() == 1) {
            in_one_ = std::make_unique<EventDriven<Real>>(scene);
        } else {
            in_tiles_ = std::make_unique<EventWindows<Real>>(scene, threads, WindowSettings{.tiles = tiles});
        }
    }

    /// Goes back to the start of a scene with the same box and as many discs.
    void restart(const Scene& scene) { in_one_ ? in_one_->restart(scene) : in_tiles_->restart(scene); }

    /// Goes on to `time`, from 0 at the start. False if a limit is passed; time() then tells how far it came.
    bool advance(Real time, const EventLimits& limits = {}) {
        return in_one_ ? in_one_->advance(time, limits) : in_tiles_->advance(time, limits);
    }

    /// The discs as they are now, disc i at index i.
    std::vector<BasicDisc<Real>> discs() const { return in_one_ ? in_one_->discs() : in_tiles_->discs(); }

    Real time() const { return in_one_ ? in_one_->time() : in_tiles_->time(); }

    std::int64_t pair_collisions() const {
        return in_one_ ? in_one_->pair_collisions() : in_tiles_->pair_collisions();
    }
    std::int64_t wall_collisions() const {
        return in_one_ ? in_one_->wall_collisions() : in_tiles_->wall_collisions();
    }

    /// The momentum that all four walls have taken up so far, the sum of 2 |v| over wall collisions, for unit
    /// mass.
    Real wall_impulse() const { return in_one_ ? in_one_->wall_impulse() : in_tiles_->wall_impulse(); }

    /// What the walls have changed of the momentum of all discs along x and y, for unit mass.
    std::array<Real, 2> momentum_from_walls() const {
        return in_one_ ? in_one_->momentum_from_walls() : in_tiles_->momentum_from_walls();
    }

  private:
    std::unique_ptr<EventDriven<Real>> in_one_;
    std::unique_ptr<EventWindows<Real>> in_tiles_;
};

/// The same, beside which goes the simulation in one piece and tells its collisions, in order. States and
/// counts are those of the first: whoever holds them against what is told finds where the two differ.
class ToldSimulation : public ExactSimulation<double> {
  public:
    ToldSimulation(const Scene& scene, int threads, CollisionLog<double>& log)
        : ExactSimulation(scene, threads), told_(scene, log) {}

    void restart(const Scene& scene) {
        ExactSimulation::restart(scene);
        told_.restart(scene);
    }

    bool advance(double time) {
        const bool ended = told_.advance(time);
        return ExactSimulation::advance(time) && ended;
    }

  private:
    EventDriven<double, CollisionLog<double>&> told_;
};

} // namespace carom
