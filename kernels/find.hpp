#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "collide.hpp"
#include "look_ahead.hpp"
#include "parallel_for.hpp"
#include "policies.hpp"
#include "resolve_lists.hpp"
#include "state.hpp"
#include "tally.hpp"

namespace carom {

/// The boxes, along one axis, that a disc at `position` in box `index` looks into. Specialised by
/// neighbourhood.
template <Neighbourhood neighbourhood> struct Look;

template <> struct Look<Neighbourhood::nine> {
    static BoxRange along(const Grid& grid, double /*position*/, int index) {
        return {std::max(index - 1, 0), std::min(index + 1, grid.boxes_per_side() - 1)};
    }
};

template <> struct Look<Neighbourhood::four> {
    static BoxRange along(const Grid& grid, double position, int index) {
        const int other = std::clamp(index + grid.nearer_side(position), 0, grid.boxes_per_side() - 1);
        return {std::min(index, other), std::max(index, other)};
    }
};

/// Calls `look(row, column)` for each box that a disc of box (row, column) looks into, but for its own, in
/// the published order: of four boxes the neighbour along x, the one along y, the diagonal one; of nine
/// column by column.
template <Neighbourhood neighbourhood, class LookInto>
void for_each_other_box(BoxRange rows, BoxRange columns, int row, int column, const LookInto& look) {
    if constexpr (neighbourhood == Neighbourhood::nine) {
        for (int other_column = columns.first; other_column <= columns.last; ++other_column) {
            for (int other_row = rows.first; other_row <= rows.last; ++other_row) {
                if (other_row != row || other_column != column) {
                    look(other_row, other_column);
                }
            }
        }
    } else {
        const int other_row = rows.first + rows.last - row;
        const int other_column = columns.first + columns.last - column;
        if (other_column != column) {
            look(row, other_column);
        }
        if (other_row != row) {
            look(other_row, column);
            if (other_column != column) {
                look(other_row, other_column);
            }
        }
    }
}

// The two that follow have one caller each. Written out there, clang++ 14 made code that was 3 % slower
// (100 000 discs, 2 threads).

/// Calls `on_pair(i, j)` for each pair of one box's discs that is no farther apart than the root of
/// `reach_squared`, i before j.
template <Policies policies, class OnPair>
void for_each_pair_within(const State<policies>& state, int row, int column,
                          RealOf<policies.precision> reach_squared, const OnPair& on_pair) {
    const auto& own = state.discs_in(row, column);
    for (auto i = own.begin(); i != own.end(); ++i) {
        const auto& disc = state.disc(*i);
        auto j = i;
        for (++j; j != own.end(); ++j) {
            if (overlap(disc, state.disc(*j), reach_squared)) {
                on_pair(*i, *j);
            }
        }
    }
}

/// Calls `on_other(j)` for each disc j of the other boxes that disc i of box (row, column) looks into, if it
/// is no farther away than the root of `reach_squared`.
template <Policies policies, class OnOther>
void for_each_other_beyond(const State<policies>& state, int i, int row, int column,
                           RealOf<policies.precision> reach_squared, const OnOther& on_other) {
    const auto disc = state.disc(i);
    const auto look = [&](int other_row, int other_column) {
        for (const int j : state.discs_in(other_row, other_column)) {
            if (overlap(disc, state.disc(j), reach_squared)) {
                on_other(j);
            }
        }
    };
    for_each_other_box<policies.neighbourhood>(
        Look<policies.neighbourhood>::along(state.grid, disc.y, row),
        Look<policies.neighbourhood>::along(state.grid, disc.x, column), row, column, look);
}

/// Finds the overlaps within one box, each pair once, and resolves it at once if asked to.
template <Policies policies>
void find_within_box(State<policies>& state, int row, int column,
                     const ApproachToleranceOf<policies>& approaching, Tally& tally) {
    for (const int i : state.discs_in(row, column)) {
        state.overlaps[static_cast<std::size_t>(i)].clear();
    }
    for_each_pair_within(state, row, column, state.reach_squared(), [&](int i, int j) {
        state.overlaps[static_cast<std::size_t>(i)].push_back(j);
        state.overlaps[static_cast<std::size_t>(j)].push_back(i);
        if constexpr (policies.self_contained == SelfContained::on) {
            ++tally.pair_attempts;
            tally.pair_resolves += resolve_pair(state.disc(i), state.disc(j), approaching);
        }
    });
}

/// Resolves within one box until no pair in it collides. What is left after `rounds_within_box` rounds the
/// resolve of the step will find.
template <Policies policies>
Changes resolve_within_box(State<policies>& state, int row, int column,
                           const ApproachToleranceOf<policies>& approaching) {
    Remembered remembered;
    Changes changes =
        visit_each<Changes, LookAtWalls::no>(state, state.discs_in(row, column), remembered, approaching);
    for (int round = 0; round < rounds_within_box && !remembered.next.empty(); ++round) {
        changes += visit_remembered<Changes, LookAtWalls::no>(state, remembered, approaching);
    }
    return changes;
}

/// Finds the overlaps of one box's discs with those of other boxes, and which of its discs overlap a wall.
/// Returns how many entries the lists of the box's discs have in all.
template <Policies policies> std::int64_t find_beyond_box(State<policies>& state, int row, int column) {
    const auto reach_squared = state.reach_squared();
    const bool at_wall = state.grid.at_wall(row, column);
    std::int64_t entries = 0;
    for (const int i : state.discs_in(row, column)) {
        auto& overlaps = state.overlaps[static_cast<std::size_t>(i)];
        for_each_other_beyond(state, i, row, column, reach_squared, [&](int j) { overlaps.push_back(j); });
        state.overlaps_wall[static_cast<std::size_t>(i)] =
            at_wall && overlaps_wall(state.disc(i), state.side, state.radius);
        entries += static_cast<std::int64_t>(overlaps.size());
    }
    return entries;
}

/// Finds the overlaps of every disc of one box and notes which overlap a wall; with self-contained resolves,
/// before it looks into other boxes it resolves within the box until no pair there collides. `entries` is
/// raised by the length of the lists.
///
/// Any two boxes may run at the same time: only the lists and the velocities of the box's own discs are
/// written, and of other boxes only positions are read, which nobody writes.
template <Policies policies>
void find_in_box(State<policies>& state, int row, int column,
                 const ApproachToleranceOf<policies>& approaching, Tally& tally) {
    find_within_box(state, row, column, approaching, tally);
    if constexpr (policies.self_contained == SelfContained::on) {
        tally += resolve_within_box(state, row, column, approaching);
    }
    tally.overlaps += find_beyond_box(state, row, column);
}

/// Finds the overlaps of all discs, a box to an iteration.
template <Policies policies, class SomeProbe>
    requires(policies.overlaps == Overlaps::lists)
Tally find(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    const ApproachToleranceOf<policies> approaching(tuning.tolerance);
    const int boxes_per_side = state.grid.boxes_per_side();
    Tally tally = parallel_for_boxes<policies.find_schedule, Tally>(
        tuning.threads, boxes_per_side, boxes_per_side, tuning.find_chunk, probe,
        [&](int row, int column, Tally& sum) {
            look_ahead_to_find(state, row, column);
            if (!state.is_empty(row, column)) {
                find_in_box(state, row, column, approaching, sum);
            }
        });
    tally.overlaps /= 2; // each pair stands in two lists
    return tally;
}

} // namespace carom
