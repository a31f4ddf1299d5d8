#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/collisions/collision_checker.hpp"
#include "harness/measure/turns.hpp"
#include "harness/support/stopwatch.hpp"
#include "harness/verify/checker.hpp"
#include "harness/verify/rounding.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"
#include "kernels/state.hpp"
#include "variants/registry.hpp"

namespace carom {

/// Which steps of a run the checker looks at.
enum class CheckScope { nothing, last_step, every_step };

/// What the checker looks at, and whose precision and time of impact it expects. `collisions`,
/// if it is not null, is who is told every collision of the run: then it checks the steps. `right_ends`, if
/// it is not null, has the hashes of final states whose last step was found right: one that ends in the same
/// bits is right, one that is found right is added.
struct Check {
    CheckScope scope;
    Engine engine = Engine::steps;
    Policies policies;
    CollisionChecker* collisions = nullptr;
    std::set<std::string>* right_ends = nullptr;

    Check(CheckScope some_scope) : scope(some_scope) {} // NOLINT(*-explicit-*)
    Check(CheckScope some_scope, const Variant& variant, CollisionChecker* some_collisions = nullptr)
        : scope(some_scope), engine(variant.engine), policies(variant.policies), collisions(some_collisions) {
    }
};

/// A run of all S steps of a scene.
struct Run {
    double steps_seconds = 0;             ///< wall time of the steps alone
    double cpu_seconds = 0;               ///< process CPU time of the steps, all threads
    Tally work;                           ///< summed over the steps
    std::vector<Disc> discs;              ///< the final state
    std::optional<std::string> violation; ///< the first one found, with its step, or nothing
};

/// Called after each unit of time with its number, from 1.
using OnStep = std::function<void(int step, const Simulation& simulation)>;

/// A run from the scene's initial state, some steps at a time; of those at whose ends nobody looks, as many
/// at once as there are. The stopwatch runs while it steps, but not while the checker and `on_step` work or
/// the checker's copy is made. A resolve given up at the sweep limit ends the run with a violation. What it
/// is given must outlive it.
class RunInParts {
  public:
    RunInParts(const Scene& scene, Simulation& simulation, const Tuning& tuning, const Check& check,
               OnStep on_step = nullptr, Stopwatch stopwatch = {});

    /// Simulates up to `steps` units of time more, fewer at the end of the scene or at a violation. Returns
    /// the wall time that they took.
    TurnTime advance(int steps);

    /// Units of time so far.
    int done() const { return done_; }

    /// Is there nothing left to simulate?
    bool ended() const { return done_ >= scene_.steps || run_.violation; }

    /// What was run, with the state as it is now.
    Run finish();

  private:
    void go_on_to(int end);
    int unseen_until(int end) const;
    void advance_unseen(int units);
    void advance_by_one();
    void step(int substep);
    std::optional<std::string> violation_after(const std::vector<Disc>& after) const;
    std::string violation_unsettled() const;

    const Scene& scene_;
    Simulation& simulation_;
    const Tuning& tuning_;
    Check check_;
    Checker checker_;
    OnStep on_step_;
    Stopwatch stopwatch_;
    Run run_;
    std::vector<Disc> before_; ///< the state before the step that is checked
    int done_ = 0;             ///< units of time
};

/// The whole run at once.
Run run_scene(const Scene& scene, Simulation& simulation, const Tuning& tuning, const Check& check,
              const OnStep& on_step = nullptr, Stopwatch stopwatch = {});

/// A whole run of a variant of which every step is checked: by its collisions, where the variant tells them
/// (`simulate_logged`), else by the states at its ends.
Run checked_run(const Scene& scene, const Variant& variant, const Tuning& tuning,
                const OnStep& on_step = nullptr);

/// FNV-1a (Fowler, Noll, Vo) over the bits of all positions and velocities, as 16 hexadecimal digits.
std::string state_hash(const std::vector<Disc>& discs);

} // namespace carom
