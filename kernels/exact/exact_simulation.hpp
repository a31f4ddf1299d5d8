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
///
/// `Log` is told every collision, in order; CollisionLog<Real>& is one that can.
template <class Real, class Log = NoCollisionLog> class ExactSimulation {
  public:
    ExactSimulation(const Scene& scene, int threads, Log log = Log()) {
        const TileCounts tiles = tiles_for(scene.discs.size(), threads);
        if (tiles.all() == 1) {
            in_one_ = std::make_unique<EventDriven<Real, Log>>(scene, log);
        } else {
            in_tiles_ = std::make_unique<EventWindows<Real, Log>>(scene, threads,
                                                                  WindowSettings{.tiles = tiles}, log);
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
    std::unique_ptr<EventDriven<Real, Log>> in_one_;
    std::unique_ptr<EventWindows<Real, Log>> in_tiles_;
};

} // namespace carom
