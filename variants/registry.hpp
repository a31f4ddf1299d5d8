#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "kernels/policies.hpp"
#include "kernels/probe.hpp"
#include "kernels/scene.hpp"
#include "kernels/state.hpp"
#include "variants/engine.hpp"

namespace carom {

/// A running simulation of one scene by one variant.
class Simulation {
  public:
    virtual ~Simulation() = default;

    /// One time step of dt = 1 / substeps.
    virtual Tally step() = 0;

    /// What time steps did, and how many they were.
    struct Steps {
        Tally work;
        std::int64_t count = 0;
    };

    /// Up to so many time steps, at whose ends nobody looks; the last one if it does not settle.
    virtual Steps steps(std::int64_t most) {
        Steps taken;
        for (; taken.count < most && taken.work.settled; ++taken.count) {
            taken.work += step();
        }
        return taken;
    }

    /// Goes back to the start of the scene it was made of, and keeps its memory: what follows are the same
    /// bits as of a new one, with no memory touched for the first time and no list grown twice.
    virtual void restart(const Scene& scene) = 0;

    /// A copy of the discs as they are now, disc i at index i.
    virtual std::vector<Disc> discs() const = 0;
};

/// One row of the table, or the event-driven simulation, with what it takes to run it.
struct Variant {
    std::string_view name;
    Engine engine = Engine::steps;
    Policies policies;

    /// Starts a simulation; throws std::bad_alloc if there is no memory for it. `tuning` must hold positive
    /// numbers.
    std::unique_ptr<Simulation> (*simulate)(const Scene&, const Tuning&);

    /// The same, telling `probe` what it does. `probe` must outlive the simulation. Null for the event-driven
    /// simulation, which has no phases.
    std::unique_ptr<Simulation> (*simulate_observed)(const Scene&, const Tuning&, Probe& probe);

    /// The same, telling `log` every collision and ending in the same bits. `log` must outlive the
    /// simulation. Null where collisions happen at the step's end: of those the states tell all.
    std::unique_ptr<Simulation> (*simulate_logged)(const Scene&, const Tuning&, CollisionLog<double>& log);
};

/// Every variant of the table, in its order.
std::span<const Variant> variants();

/// The variant of that name, be it in the table or event_driven(), or null.
const Variant* find_variant(std::string_view name);

} // namespace carom
