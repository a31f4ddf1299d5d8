#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "collide.hpp"
#include "contacts.hpp"
#include "policies.hpp"
#include "state.hpp"
#include "tally.hpp"

// Why no two threads touch the same disc or mark. Strips of one parity run at the same time. The contacts of
// a strip are between its own discs, and between its last row and the first row of the next strip; so a strip
// touches discs of itself and of the next one's first row, and no other strip of its parity touches either.
// It marks blocks of the rows of those discs and of the rows before: from the last row of the strip before to
// the first row of the next. The next strip of the same parity begins to mark at the last row of the strip
// between, and that is another row, since a strip has two rows or more (but for the last, which none
// follows). So the result does not depend, to the last bit, on the number of threads.

namespace carom {

/// Looks at contacts [begin, end) of a strip and writes those that may collide to `colliding`, in their
/// order; returns its end. No branch depends on the outcome, which no processor can predict.
template <Policies policies>
int* look_at_contacts(const State<policies>& state, const Strip<RealOf<policies.precision>>& strip, int begin,
                      int end, int* colliding) {
    const auto* const discs = state.discs.data();
    const auto* const contacts = strip.contacts.data();
    for (int k = begin; k < end; ++k) {
        const auto [first, second] = contacts[k].discs;
        *colliding = k;
        colliding += !(approach_along(contacts[k].normal, discs[first], discs[second]) >= 0);
    }
    return colliding;
}

/// Resolves those of the contacts that still collide, in their order. `on_change(i)` is called for each disc
/// changed.
template <Policies policies, class OnChange>
Changes resolve_contacts(State<policies>& state, const Strip<RealOf<policies.precision>>& strip,
                         const int* begin, const int* end, const ApproachOf<policies>& approaching,
                         const OnChange& on_change) {
    Changes changes;
    auto* const discs = state.discs.data();
    for (const int* k = begin; k != end; ++k) {
        const auto& contact = strip.contacts[static_cast<std::size_t>(*k)];
        const auto [first, second] = contact.discs;
        if (contact.discs.at_wall()) [[unlikely]] {
            if (const int turned = resolve_walls(discs[first], state.side, state.radius)) {
                changes.walls += turned;
                on_change(first);
            }
        } else if (resolve_along(contact.normal, discs[first], discs[second], approaching)) {
            ++changes.pairs;
            on_change(first);
            on_change(second);
        }
    }
    return changes;
}

/// Blocks whose contacts are all looked at before the first of them is resolved. With more of them fewer
/// predictions fail, but more contacts are looked at too early: it takes more sweeps.
inline constexpr int blocks_at_once = 4;

/// What one strip does in a sweep. All of it, or the blocks with a disc that has changed since they were
/// looked at, those included that become active on the way: what is left out would change nothing.
template <Policies policies>
    requires(policies.overlaps == Overlaps::contacts)
Changes resolve_strip(State<policies>& state, int index, const ApproachOf<policies>& approaching) {
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    const int first_row = state.grid.rows_of_strip(index, strip_height(policies.order)).first;
    unsigned char* const active = state.active.row(first_row);
    const auto marker = state.active.marker();
    const int* const block_of_disc = state.block_of_disc.data();
    const auto on_change = [&](int i) {
        if constexpr (policies.worklist == Worklist::active) {
            marker.mark(block_of_disc[i]);
        }
    };
    const auto is_active = [&](int block) {
        return policies.worklist == Worklist::all || std::exchange(active[block], 0) != 0;
    };
    Changes changes;
    const int blocks = static_cast<int>(strip.first.size()) - 1;
    for (int block = 0; block < blocks;) {
        int* const begin = strip.colliding.data();
        int* end = begin;
        for (const int stop = std::min(block + blocks_at_once, blocks); block < stop; ++block) {
            if (is_active(block)) {
                const int* const first = strip.first.data() + block;
                end = look_at_contacts(state, strip, first[0], first[1], end);
            }
        }
        changes += resolve_contacts(state, strip, begin, end, approaching, on_change);
    }
    return changes;
}

} // namespace carom
