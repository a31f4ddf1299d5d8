#pragma once

#include <algorithm>

#include "collide.hpp"
#include "parallel_for.hpp"
#include "policies.hpp"
#include "state.hpp"

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
        const int other = std::clamp(index + grid.reach(position, index), 0, grid.boxes_per_side() - 1);
        return {std::min(index, other), std::max(index, other)};
    }
};

/// Finds the overlaps of every disc of one box, from the lowest row and column looked into to the highest,
/// and resolves those within the box if asked to.
///
/// Any two boxes may run at the same time: only the lists and the velocities of the box's own discs are
/// written, and of other boxes only positions are read, which nobody writes.
template <Policies policies>
Tally find_in_box(State<policies>& state, int row, int column, const ApproachOf<policies>& approaching) {
    Tally tally;
    const auto reach_squared = state.reach_squared();
    for (const int i : state.discs_in(row, column)) {
        auto& disc = state.discs[static_cast<std::size_t>(i)];
        auto& overlaps = state.overlaps[static_cast<std::size_t>(i)];
        overlaps.clear();
        const BoxRange rows = Look<policies.neighbourhood>::along(state.grid, disc.y, row);
        const BoxRange columns = Look<policies.neighbourhood>::along(state.grid, disc.x, column);
        for (int other_row = rows.first; other_row <= rows.last; ++other_row) {
            for (int other_column = columns.first; other_column <= columns.last; ++other_column) {
                [[maybe_unused]] const bool own = other_row == row && other_column == column;
                for (const int j : state.discs_in(other_row, other_column)) {
                    auto& other = state.discs[static_cast<std::size_t>(j)];
                    if (i == j || !overlap(disc, other, reach_squared)) {
                        continue;
                    }
                    overlaps.push_back(j);
                    tally.overlaps += i < j;
                    if constexpr (policies.self_contained == SelfContained::on) {
                        tally.pair_resolves += own && resolve_pair(disc, other, approaching);
                    }
                }
            }
        }
    }
    return tally;
}

/// Finds the overlaps of all discs, a box to an iteration.
template <Policies policies, class SomeProbe>
    requires(policies.overlaps == Overlaps::lists)
Tally find(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    const ApproachOf<policies> approaching(tuning.tolerance);
    const int columns = state.grid.boxes_per_side();
    return parallel_for<policies.find_schedule>(
        tuning.threads, state.grid.box_count(), tuning.find_chunk, probe,
        [&](int box) { return find_in_box(state, box / columns, box % columns, approaching); });
}

} // namespace carom
