#pragma once

#include <cstddef>

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

/// Looks at the contacts of [begin, end) in their order. `on_change(i)` is called for each disc changed.
template <Policies policies, class OnChange>
Changes resolve_contacts(State<policies>& state, const Contact<RealOf<policies.precision>>* begin,
                         const Contact<RealOf<policies.precision>>* end,
                         const ApproachOf<policies>& approaching, const OnChange& on_change) {
    Changes changes;
    auto* const discs = state.discs.data();
    for (const auto* contact = begin; contact != end; ++contact) {
        const auto [first, second] = contact->discs;
        if (second == OverlappingDiscs::wall) [[unlikely]] {
            if (const int turned = resolve_walls(discs[first], state.side, state.radius)) {
                changes.walls += turned;
                on_change(first);
            }
        } else if (resolve_along(contact->normal_x, discs[first], discs[second], approaching)) {
            ++changes.pairs;
            on_change(first);
            on_change(second);
        }
    }
    return changes;
}

/// What one strip does in a sweep. All of it, or the blocks with a disc that has changed since they were
/// looked at, those included that become active on the way: what is left out would change nothing.
template <Policies policies>
    requires(policies.overlaps == Overlaps::contacts)
Changes resolve_strip(State<policies>& state, int index, const ApproachOf<policies>& approaching) {
    const auto& strip = state.strips[static_cast<std::size_t>(index)];
    const auto* const contacts = strip.contacts.data();
    if constexpr (policies.worklist == Worklist::all) {
        return resolve_contacts(state, contacts, contacts + strip.contacts.size(), approaching, [](int) {});
    }
    Changes changes;
    const int first_row = state.grid.rows_of_strip(index, strip_height(policies.order)).first;
    unsigned char* const active = state.active.row(first_row);
    const auto marker = state.active.marker();
    const int* const block_of_disc = state.block_of_disc.data();
    for (std::size_t block = 0; block + 1 < strip.first.size(); ++block) {
        if (active[block] != 0) {
            active[block] = 0;
            changes +=
                resolve_contacts(state, contacts + strip.first[block], contacts + strip.first[block + 1],
                                 approaching, [&](int i) { marker.mark(block_of_disc[i]); });
        }
    }
    return changes;
}

} // namespace carom
