#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

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
// the nearest edge, which brings no two discs further apart.) The iterations of one colour, or of one parity
// of rows, therefore neither write what another reads nor depend on the order in which they run: the result
// is the same, to the last bit, for any number of threads and any schedule.

namespace carom {

/// How many of the indices below `count` have the parity of `first`, which is 0 or 1.
constexpr int every_other(int count, int first) { return (count - first + 1) / 2; }

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
Swept sweep_checkered(State<policies>& state, const Tuning& tuning, const ApproachOf<policies>& approaching,
                      SomeProbe& probe) {
    Tally tally;
    const int side = state.grid.boxes_per_side();
    for (int first_row = 0; first_row < 2; ++first_row) {
        for (int first_column = 0; first_column < 2; ++first_column) {
            const int columns = every_other(side, first_column);
            const int boxes = every_other(side, first_row) * columns;
            tally += parallel_for<policies.resolve_schedule>(
                tuning.threads, boxes, tuning.resolve_chunk, probe, [&](int box) {
                    const int row = first_row + 2 * (box / columns);
                    const int column = first_column + 2 * (box % columns);
                    return Tally(resolve_box(state, row, column, approaching));
                });
        }
    }
    return one_sweep(tally);
}

/// One sweep of `row` or `strips`. A row is a strip of one row.
template <Policies policies, class SomeProbe>
Swept sweep_strips(State<policies>& state, const Tuning& tuning, const ApproachOf<policies>& approaching,
                   SomeProbe& probe) {
    Tally tally;
    const int count = state.grid.strip_count(strip_height(policies.order));
    for (int first = 0; first < 2; ++first) {
        tally += parallel_for<policies.resolve_schedule>(
            tuning.threads, every_other(count, first), tuning.resolve_chunk, probe,
            [&](int k) { return Tally(resolve_strip(state, first + 2 * k, approaching)); });
    }
    return one_sweep(tally);
}

/// Can disc i touch a wall, as far as its box tells?
template <Policies policies> bool at_wall(const State<policies>& state, int i) {
    const auto& disc = state.discs[static_cast<std::size_t>(i)];
    return state.grid.at_wall(state.grid.coordinate(disc.y), state.grid.coordinate(disc.x));
}

/// One sweep of `once` or `repeat`: every disc in the order of its number.
template <Policies policies>
Swept sweep_discs(State<policies>& state, const ApproachOf<policies>& approaching) {
    Tally tally;
    for (int i = 0; i < state.count(); ++i) {
        if constexpr (policies.order == Order::repeat) {
            tally += resolve_disc(state, i, at_wall(state, i), approaching, ignore_partner);
        } else {
            tally += resolve_disc_once(state, i, at_wall(state, i), approaching, ignore_partner);
        }
    }
    return one_sweep(tally);
}

/// The discs that `track` has yet to visit: a partner changed them after their own last visit.
struct Pending {
    std::vector<int> now;
    std::vector<int> next;
    std::vector<unsigned char> is_pending;

    explicit Pending(int count) : is_pending(static_cast<std::size_t>(count), 1) {
        for (int i = 0; i < count; ++i) {
            now.push_back(i);
        }
    }
};

/// One sweep of `track`: the pending discs, in the order in which they came to be pending.
template <Policies policies>
Swept sweep_pending(State<policies>& state, Pending& pending, const ApproachOf<policies>& approaching) {
    Tally tally;
    const auto remember = [&](int j) {
        if (!pending.is_pending[static_cast<std::size_t>(j)]) {
            pending.is_pending[static_cast<std::size_t>(j)] = 1;
            pending.next.push_back(j);
        }
    };
    for (const int i : pending.now) {
        pending.is_pending[static_cast<std::size_t>(i)] = 0;
        const Changes changes = resolve_disc(state, i, at_wall(state, i), approaching, remember);
        tally += changes;
        if (changes.count() >= passes_per_visit) {
            remember(i);
        }
    }
    pending.now.swap(pending.next);
    pending.next.clear();
    Swept swept = one_sweep(tally);
    swept.last_changes = std::ssize(pending.now);
    return swept;
}

} // namespace carom
