#pragma once

#include "policies.hpp"
#include "state.hpp"
#include "sweep.hpp"
#include "tally.hpp"

namespace carom {

/// A parallel loop costs about as much as this many resolves. A sweep after one that changed less runs on one
/// thread.
inline constexpr int few_changes = 300;

/// Changes velocities until no pair and no wall is colliding, or the sweep limit is reached.
template <Policies policies, class SomeProbe>
Tally resolve(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    const ApproachOf<policies> approaching(tuning.tolerance);
    [[maybe_unused]] Pending pending(policies.order == Order::track ? state.count() : 0);
    [[maybe_unused]] Tuning one_thread = tuning;
    one_thread.threads = 1;
    Tally total;
    Tally last{.pair_resolves = few_changes};
    bool changed = true;
    while (changed) {
        if (total.sweeps == tuning.sweep_limit) {
            total.settled = false;
            return total;
        }
        probe.sweep_begin();
        if constexpr (policies.order == Order::checkered) {
            last = sweep_checkered(state, tuning, approaching, probe);
        } else if constexpr (policies.order == Order::track) {
            last = sweep_pending(state, pending, approaching);
        } else if constexpr (is_sequential(policies.order)) {
            last = sweep_discs(state, approaching);
        } else {
            const bool few = policies.worklist == Worklist::active && last.pair_resolves < few_changes;
            last = sweep_strips(state, few ? one_thread : tuning, approaching, probe);
        }
        probe.sweep_end();
        ++total.sweeps;
        total += last;
        changed = policies.order == Order::track ? !pending.now.empty() : last.changed();
    }
    return total;
}

} // namespace carom
