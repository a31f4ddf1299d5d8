#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "policies.hpp"
#include "state.hpp"

// Prefetch::on. The published layout leads from a box to its list, from there to discs and their lists, and
// none of these lie near one another: a thread would wait for one cache line after another. So the loops over
// boxes ask for what the boxes after the present one will read. What is needed last is asked for first, since
// each thing must have arrived for the next to be known. No result depends on it.
//
// Every function here is inlined always: g++ takes a function that only prefetches for one that does nothing.

namespace carom {

/// The list of discs of the box that comes `ahead` boxes after (row, column) in memory, or of the last one.
template <Policies policies>
[[gnu::always_inline]] inline const std::vector<int>& box_ahead(const State<policies>& state, int row,
                                                                int column, int ahead) {
    const int box = std::min(state.grid.box_of(row, column) + ahead, state.grid.box_count() - 1);
    return state.boxes[static_cast<std::size_t>(box)];
}

/// Asks for what a list points to.
[[gnu::always_inline]] inline void prefetch_entries(const std::vector<int>& list) {
    if (!list.empty()) {
        __builtin_prefetch(list.data());
    }
}

/// Asks for some discs and for where their lists are.
template <Policies policies>
[[gnu::always_inline]] inline void prefetch_discs(const State<policies>& state,
                                                  const std::vector<int>& discs) {
    for (const int i : discs) {
        __builtin_prefetch(&state.disc(i));
        __builtin_prefetch(&state.overlaps[static_cast<std::size_t>(i)]);
    }
}

/// For a loop that finds in every box: as above, and where the lists of the boxes of the next row are.
template <Policies policies>
[[gnu::always_inline]] inline void look_ahead_to_find(const State<policies>& state, int row, int column) {
    if constexpr (policies.prefetch == Prefetch::on) {
        const int ahead = state.boxes_ahead;
        prefetch_entries(box_ahead(state, row, column, 3 * ahead));
        prefetch_discs(state, box_ahead(state, row, column, 2 * ahead));
        __builtin_prefetch(&box_ahead(state, row + 1, column, 2 * ahead));
    }
}

/// For a loop that resolves in every `stride`-th box of a row: as above, and the lists of the discs.
template <Policies policies>
[[gnu::always_inline]] inline void look_ahead_to_resolve(const State<policies>& state, int row, int column,
                                                         int stride) {
    if constexpr (policies.prefetch == Prefetch::on) {
        const int ahead = stride * state.boxes_ahead;
        prefetch_entries(box_ahead(state, row, column, 3 * ahead));
        prefetch_discs(state, box_ahead(state, row, column, 2 * ahead));
        for (const int i : box_ahead(state, row, column, ahead)) {
            __builtin_prefetch(state.overlaps[static_cast<std::size_t>(i)].data());
        }
    }
}

} // namespace carom
