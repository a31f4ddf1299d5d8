#pragma once

#include "at_contact_strips.hpp"
#include "policies.hpp"
#include "state.hpp"
#include "sweep.hpp"
#include "tally.hpp"
#include "wavefront.hpp"

namespace carom {

/// Changes velocities until no pair and no wall is colliding, or the sweep limit is reached.
template <Policies policies, class SomeProbe>
Tally resolve_in_place(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    const ApproachToleranceOf<policies> approaching(tuning.tolerance);
    [[maybe_unused]] Remembered remembered;
    [[maybe_unused]] Wavefront wavefront(
        policies.order == Order::wavefront ? state.grid.strip_count(strip_height(policies.order)) : 0);
    [[maybe_unused]] const bool skewed = policies.order == Order::wavefront && exceeds_cache(state, tuning);
    Tuning one_thread = tuning;
    one_thread.threads = 1;
    Tally total;
    Swept last{.last_changes = few_changes};
    while (last.last_changes > 0) {
        if (total.sweeps == tuning.sweep_limit) {
            total.settled = false;
            return total;
        }
        const bool few = policies.worklist == Worklist::active && last.last_changes < few_changes;
        [[maybe_unused]] const Tuning& now = few ? one_thread : tuning;
        probe.sweep_begin();
        if constexpr (policies.order == Order::checkered) {
            last = sweep_checkered(state, tuning, approaching, probe);
        } else if constexpr (policies.order == Order::track) {
            last = sweep_track(state, remembered, total.sweeps == 0, approaching);
        } else if constexpr (is_sequential(policies.order)) {
            last = sweep_discs(state, approaching);
        } else if constexpr (policies.order == Order::wavefront) {
            const int done = static_cast<int>(total.sweeps);
            last = sweep_wavefront(state, wavefront, done, tuning.sweep_limit - done, skewed, now,
                                   approaching, probe);
        } else {
            last = sweep_strips(state, now, approaching, probe);
        }
        probe.sweep_end();
        total += last.work;
    }
    return total;
}

/// The same, after collisions were taken back to their time of contact, if they are to be.
template <Policies policies, class SomeProbe>
Tally resolve(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    Tally total;
    if constexpr (policies.impact == Impact::at_contact) {
        total += collide_at_contact(state, tuning, probe);
        total += find_left(state, tuning, probe);
    }
    total += resolve_in_place(state, tuning, probe);
    return total;
}

} // namespace carom
