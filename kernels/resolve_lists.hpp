#pragma once

#include <algorithm>
#include <cstddef>

#include "collide.hpp"
#include "policies.hpp"
#include "state.hpp"
#include "tally.hpp"

namespace carom {

/// One pass over a disc's walls and its whole list of overlaps. `on_partner(j)` is called for each partner
/// changed.
template <Policies policies, class OnPartner>
[[gnu::always_inline]] inline Changes resolve_disc_once(State<policies>& state, int i, bool at_wall,
                                                        const ApproachOf<policies>& approaching,
                                                        const OnPartner& on_partner) {
    Changes changes;
    auto& disc = state.discs[static_cast<std::size_t>(i)];
    const auto against = [&](int j) {
        if (resolve_pair(disc, state.discs[static_cast<std::size_t>(j)], approaching)) {
            ++changes.pairs;
            on_partner(j);
        }
    };
    if (at_wall) {
        changes.walls = resolve_walls(disc, state.side, state.radius);
    }
    const auto& overlaps = state.overlaps[static_cast<std::size_t>(i)];
    if constexpr (policies.direction == Direction::reverse) {
        std::for_each(overlaps.rbegin(), overlaps.rend(), against);
    } else {
        std::for_each(overlaps.begin(), overlaps.end(), against);
    }
    return changes;
}

/// Passes over a disc again and again while anything changes.
template <Policies policies, class OnPartner>
[[gnu::always_inline]] inline Changes resolve_disc(State<policies>& state, int i, bool at_wall,
                                                   const ApproachOf<policies>& approaching,
                                                   const OnPartner& on_partner) {
    Changes total;
    for (int pass = 0; pass < passes_per_visit; ++pass) {
        const Changes changes = resolve_disc_once(state, i, at_wall, approaching, on_partner);
        total += changes;
        if (!changes.any()) {
            break;
        }
    }
    return total;
}

inline constexpr auto ignore_partner = [](int) {};

template <Policies policies>
Changes resolve_box(State<policies>& state, int row, int column, const ApproachOf<policies>& approaching) {
    Changes changes;
    const bool at_wall = state.grid.at_wall(row, column);
    for (const int i : state.discs_in(row, column)) {
        changes += resolve_disc(state, i, at_wall, approaching, ignore_partner);
    }
    return changes;
}

/// What one strip of rows does in a sweep.
template <Policies policies>
    requires(policies.overlaps == Overlaps::lists)
Changes resolve_strip(State<policies>& state, int strip, const ApproachOf<policies>& approaching) {
    Changes changes;
    const BoxRange rows = state.grid.rows_of_strip(strip, strip_height(policies.order));
    for (int row = rows.first; row <= rows.last; ++row) {
        for (int column = 0; column < state.grid.boxes_per_side(); ++column) {
            changes += resolve_box(state, row, column, approaching);
        }
    }
    return changes;
}

} // namespace carom
