#pragma once

#include <cstdint>
#include <iterator>

#include "look_ahead.hpp"
#include "parallel_for.hpp"
#include "policies.hpp"
#include "resolve_contacts.hpp"
#include "resolve_lists.hpp"
#include "state.hpp"
#include "tally.hpp"

// One sweep of the resolve in each order.
//
// Why no two threads touch the same disc in the parallel orders. Resolving disc i writes the velocities of i
// and of the discs that overlap i, and reads nothing else that changes. Let i and k be resolved at the same
// time by two threads and suppose both touched a disc j. Then |xi - xk| <= |xi - xj| + |xj - xk| <= 4r, and
// the same in y. In the checkered order their boxes have the same colour: different, and an even number of
// rows and of columns apart, so at least two boxes apart along one axis. In the row order their rows are at
// least two apart. Either way a whole box lies between them along that axis, so they are more than one box
// side, at least 4r, apart there: a contradiction. Between two strips of one parity lies a whole strip, of at
// least two boxes of more than 2r: again more than 4r. (A centre outside the scene is binned as if moved to
// the nearest edge, which brings no two discs further apart. With Impact::at_contact discs have moved since
// they were binned; those of a list were within 2R of each other then, and boxes are made for the wider R:
// the same again with R for r.) The iterations of one colour, or of one parity of rows, therefore neither
// write what another reads nor depend on the order in which they run: the result is the same, to the last
// bit, for any number of threads and any schedule.

namespace carom {

/// How many of the indices below `count` have this parity, 0 or 1.
constexpr int every_other(int count, int parity) { return (count - parity + 1) / 2; }

/// A parallel loop costs about as much as this many resolves. A sweep after one that changed less runs on one
/// thread.
inline constexpr int few_changes = 300;

/// What a sweep did, or several that ran as one.
struct Swept {
    Tally work{};
    std::int64_t last_changes = 0; ///< of the last of them: what it changed, or what it left to be looked at
};

inline Swept one_sweep(Tally work) {
    work.sweeps = 1;
    return {work, work.pair_resolves + work.wall_resolves};
}

template <Policies policies, class SomeProbe>
Swept sweep_checkered(State<policies>& state, const Tuning& tuning,
                      const ApproachToleranceOf<policies>& approaching, SomeProbe& probe) {
    Tally tally;
    const int side = state.grid.boxes_per_side();
    for (int first_row = 0; first_row < 2; ++first_row) {
        for (int first_column = 0; first_column < 2; ++first_column) {
            tally += parallel_for_boxes<policies.resolve_schedule, Tally>(
                tuning.threads, every_other(side, first_row), every_other(side, first_column),
                tuning.resolve_chunk, probe, [&](int k, int l, Tally& sum) {
                    const int row = first_row + 2 * k;
                    const int column = first_column + 2 * l;
                    look_ahead_to_resolve(state, row, column, 2);
                    if (!state.is_empty(row, column)) {
                        sum += resolve_box(state, row, column, approaching);
                    }
                });
        }
    }
    return one_sweep(tally);
}

/// One sweep of `row` or `strips`. A row is a strip of one row.
template <Policies policies, class SomeProbe>
Swept sweep_strips(State<policies>& state, const Tuning& tuning,
                   const ApproachToleranceOf<policies>& approaching, SomeProbe& probe) {
    Tally tally;
    const int count = state.grid.strip_count(strip_height(policies.order));
    for (int parity = 0; parity < 2; ++parity) {
        tally += parallel_for<policies.resolve_schedule>(
            tuning.threads, every_other(count, parity), tuning.resolve_chunk, probe,
            [&](int k) { return Tally(resolve_strip(state, parity + 2 * k, approaching)); });
    }
    return one_sweep(tally);
}

/// One sweep of `once` or `repeat`: every disc in the order of its number.
template <Policies policies>
Swept sweep_discs(State<policies>& state, const ApproachToleranceOf<policies>& approaching) {
    Tally tally;
    for (int i = 0; i < state.count(); ++i) {
        constexpr bool again = policies.order == Order::repeat;
        tally += visit<again, policies.direction>(state, i, looks_at_wall<LookAtWalls::yes>(state, i),
                                                  approaching, ignore_partner);
    }
    return one_sweep(tally);
}

/// One sweep of `track`: every disc in the order of its number, then, sweep by sweep, the remembered ones.
template <Policies policies>
Swept sweep_track(State<policies>& state, Remembered& remembered, bool is_first,
                  const ApproachToleranceOf<policies>& approaching) {
    Swept swept =
        one_sweep(is_first ? visit_each<Tally, LookAtWalls::yes>(state, Indices{0, state.count()}, remembered,
                                                                 approaching)
                           : visit_remembered<Tally, LookAtWalls::yes>(state, remembered, approaching));
    swept.last_changes = std::ssize(remembered.next);
    return swept;
}

} // namespace carom
