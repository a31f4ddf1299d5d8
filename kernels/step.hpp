#pragma once

#include "bin.hpp"
#include "find.hpp"
#include "find_contacts.hpp"
#include "move.hpp"
#include "policies.hpp"
#include "probe.hpp"
#include "resolve.hpp"
#include "state.hpp"
#include "tally.hpp"

namespace carom {

/// One time step of dt = 1 / substeps: move every disc by v dt, then, at fixed positions, resolve until no
/// pair and no wall collides. `settled` is false in the tally returned if the resolve was given up at the
/// sweep limit.
template <Policies policies, class SomeProbe>
Tally step(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    Tally tally;

    probe.phase_begin(Phase::move);
    move(state, tuning, probe);
    probe.phase_end(Phase::move);

    probe.phase_begin(Phase::bin);
    bin(state, tuning, probe);
    probe.phase_end(Phase::bin);

    probe.phase_begin(Phase::find);
    tally += find(state, tuning, probe);
    probe.phase_end(Phase::find);

    probe.phase_begin(Phase::resolve);
    tally += resolve(state, tuning, probe);
    probe.phase_end(Phase::resolve);

    return tally;
}

} // namespace carom
