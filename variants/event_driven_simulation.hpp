#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "kernels/probe.hpp"
#include "variants/event_driven_variant.hpp"

namespace carom {

/// The event-driven simulation, by any class that does it, as one that takes steps: a step only says when to
/// look.
template <class Exact> class EventDrivenSimulation final : public Simulation {
  public:
    template <class... More>
    EventDrivenSimulation(const Scene& scene, int substeps, More&&... more)
        : exact_(scene, std::forward<More>(more)...), substeps_(substeps) {}

    Tally step() override { return steps(1).work; }

    /// In one go, since wherever somebody may look a window ends (event_windows.hpp).
    Steps steps(std::int64_t most) override {
        const std::int64_t pairs = exact_.pair_collisions();
        const std::int64_t walls = exact_.wall_collisions();
        const bool settled = exact_.advance(static_cast<double>(steps_ + most) / substeps_);
        const std::int64_t count = settled ? most : std::clamp(steps_begun() - steps_, std::int64_t{1}, most);
        steps_ += count;
        return {.work = {.pair_resolves = exact_.pair_collisions() - pairs,
                         .wall_resolves = exact_.wall_collisions() - walls,
                         .settled = settled},
                .count = count};
    }

    void restart(const Scene& scene) override {
        exact_.restart(scene);
        steps_ = 0;
    }

    std::vector<Disc> discs() const override { return exact_.discs(); }

  private:
    /// Where it stands.
    std::int64_t steps_begun() const {
        return static_cast<std::int64_t>(std::ceil(static_cast<double>(exact_.time()) * substeps_));
    }

    Exact exact_;
    double substeps_;
    std::int64_t steps_ = 0;
};

/// Of the variant. In a file of its own, as all that tells its collisions: a compiler that sees a function
/// used twice may no longer inline it into what is measured.
std::unique_ptr<Simulation> simulate_event_driven_logged(const Scene& scene, const Tuning& tuning,
                                                         CollisionLog<double>& log);

} // namespace carom
