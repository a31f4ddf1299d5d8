#pragma once

#include <algorithm>
#include <array>
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

/// Contacts that may collide, in the order in which they were looked at. Looked at first and resolved later,
/// several at a time: nothing waits for the outcome of a test that no processor can predict.
template <class Real> struct Colliding {
    static constexpr int enough = 32; ///< to be resolved; the more at a time, the more sweeps
    static constexpr int most_at_once = 64;

    std::array<const Contact<Real>*, enough + most_at_once> contacts;
    std::size_t count = 0;

    /// Looks at the contacts of [begin, end), `most_at_once` of them at most.
    void look(const Contact<Real>* begin, const Contact<Real>* end, const BasicDisc<Real>* discs) {
        for (const auto* contact = begin; contact != end; ++contact) {
            const auto [first, second] = contact->discs;
            const bool wall = second == OverlappingDiscs::wall;
            const Real approach = approach_along(contact->normal, discs[first], discs[wall ? first : second]);
            contacts[count] = contact;
            count += static_cast<std::size_t>(wall) | static_cast<std::size_t>(approach < 0);
        }
    }
};

/// Resolves what still collides. `on_change(i)` is called for each disc changed.
template <Policies policies, class OnChange>
Changes resolve_contacts(State<policies>& state, Colliding<RealOf<policies.precision>>& colliding,
                         const ApproachOf<policies>& approaching, const OnChange& on_change) {
    Changes changes;
    auto* const discs = state.discs.data();
    for (std::size_t k = 0; k < colliding.count; ++k) {
        const auto* const contact = colliding.contacts[k];
        const auto [first, second] = contact->discs;
        if (second == OverlappingDiscs::wall) [[unlikely]] {
            if (const int turned = resolve_walls(discs[first], state.side, state.radius)) {
                changes.walls += turned;
                on_change(first);
            }
        } else if (resolve_along(contact->normal, discs[first], discs[second], approaching)) {
            ++changes.pairs;
            on_change(first);
            on_change(second);
        }
    }
    colliding.count = 0;
    return changes;
}

/// What one strip does in a sweep. All of it, or the blocks with a disc that has changed since they were
/// looked at, those included that become active on the way: what is left out would change nothing.
template <Policies policies>
    requires(policies.overlaps == Overlaps::contacts)
Changes resolve_strip(State<policies>& state, int index, const ApproachOf<policies>& approaching) {
    using SomeColliding = Colliding<RealOf<policies.precision>>;
    const auto& strip = state.strips[static_cast<std::size_t>(index)];
    const auto marker = state.active.marker();
    const int* const block_of_disc = state.block_of_disc.data();
    const int first_row = state.grid.rows_of_strip(index, strip_height(policies.order)).first;
    unsigned char* const active = state.active.row(first_row);
    const auto on_change = [&](int i) {
        if constexpr (policies.worklist == Worklist::active) {
            marker.mark(block_of_disc[i]);
        }
    };
    Changes changes;
    SomeColliding colliding;
    for (std::size_t block = 0; block + 1 < strip.first.size(); ++block) {
        if (policies.worklist == Worklist::active && std::exchange(active[block], 0) == 0) {
            continue;
        }
        const auto* const end = strip.contacts.data() + strip.first[block + 1];
        for (const auto* contact = strip.contacts.data() + strip.first[block]; contact != end;) {
            const auto* const stop =
                contact + std::min<std::ptrdiff_t>(end - contact, SomeColliding::most_at_once);
            colliding.look(contact, stop, state.discs.data());
            contact = stop;
            if (colliding.count >= SomeColliding::enough) {
                changes += resolve_contacts(state, colliding, approaching, on_change);
            }
        }
    }
    return changes += resolve_contacts(state, colliding, approaching, on_change);
}

} // namespace carom
