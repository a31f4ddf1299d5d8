#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "collide.hpp"
#include "contacts.hpp"
#include "four_at_once.hpp"
#include "policies.hpp"
#include "state.hpp"
#include "tally.hpp"

// Why no two threads touch the same disc or mark. Strips run at the same time only if they are of one parity
// or, in a wavefront, at least two strips lie between them, which is all the farther. The contacts of
// a strip are between its own discs, and between its last row and the first row of the next strip; so a strip
// touches discs of itself and of the next one's first row, and no other strip of its parity touches either.
// It marks segments of the rows of those discs and of the rows before: from the last row of the strip before
// to the first row of the next. The next strip of the same parity begins to mark at the last row of the strip
// between, and that is another row, since a strip has two rows or more (but for the last, which none
// follows). So the result does not depend, to the last bit, on the number of threads.

namespace carom {

/// Adds those of the contacts [begin, end) of a strip that may collide to `colliding`.
template <Policies policies>
[[gnu::always_inline]] inline void look_at_contacts(const State<policies>& state,
                                                    const StripOf<policies>& strip, int begin, int end,
                                                    Selection& colliding) {
    const auto* const discs = state.discs.data();
    const auto* const contacts = strip.contacts.data();
    const auto approach = [&](int k) {
        const auto& contact = contacts[std::min(k, end - 1)];
        const auto [first, second] = contact.discs;
        return approach_by_component(contact.normal, discs[first], discs[second]);
    };
    for (int k = begin; k < end; k += 4) {
        const FourInts approaching =
            sums_below_zero(approach(k), approach(k + 1), approach(k + 2), approach(k + 3));
        colliding.add_four(to_bitmask(approaching & mask_of_first(end - k)), k);
    }
}

/// Resolves those of the contacts that still collide, in their order. `on_change(i)` is called for each disc
/// changed.
template <Policies policies, class OnChange>
Changes resolve_contacts(State<policies>& state, const StripOf<policies>& strip, Selection colliding,
                         const ApproachToleranceOf<policies>& approaching, const OnChange on_change) {
    Changes changes;
    auto* const discs = state.discs.data();
    const auto* const contacts = strip.contacts.data();
    for (const int k : colliding) {
        const auto& contact = contacts[k];
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

/// Which of the segments of a row are active, by their marks.
[[gnu::always_inline]] inline Selection active_segments(const unsigned char* marks, int segments,
                                                        std::span<int> room) {
    Selection active(room);
    for (int segment = 0; segment < segments; ++segment) {
        active.add_if(marks[segment] != 0, segment);
    }
    return active;
}

/// Segments whose contacts are all looked at before the first of them is resolved. With more of them fewer
/// predictions fail, but more contacts are looked at too early: it takes more sweeps.
inline constexpr int segments_at_once = 4;

/// What one row of a strip does in a sweep. `first_contact` is that of each segment of the row, and of the
/// next row's first one.
template <Policies policies, class OnChange>
Changes resolve_row(State<policies>& state, StripOf<policies>& strip, int row, const int* first_contact,
                    const ApproachToleranceOf<policies>& approaching, const OnChange on_change) {
    Changes changes;
    unsigned char* const marks = state.active.row(row);
    const Selection active = active_segments(marks, state.active.per_row(), strip.segments);
    for (const int* segment = active.begin(); segment != active.end();) {
        Selection colliding(strip.selected);
        for (const int* const stop =
                 segment + std::min<std::ptrdiff_t>(segments_at_once, active.end() - segment);
             segment != stop; ++segment) {
            if constexpr (policies.worklist == Worklist::active) {
                marks[*segment] = 0;
            }
            changes.attempts += first_contact[*segment + 1] - first_contact[*segment];
            look_at_contacts(state, strip, first_contact[*segment], first_contact[*segment + 1], colliding);
        }
        changes += resolve_contacts(state, strip, colliding, approaching, on_change);
    }
    return changes;
}

/// What one strip does in a sweep. All of it, or the segments with a disc that has changed since they were
/// looked at, of each row those that are active when its turn comes: what is left out would change nothing.
template <Policies policies>
    requires(policies.overlaps == Overlaps::contacts)
Changes resolve_strip(State<policies>& state, int index, const ApproachToleranceOf<policies>& approaching) {
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    const auto marker = state.active.marker();
    const auto* const segments_of_disc = state.segments_of_disc.data();
    const auto on_change = [=](int i) {
        if constexpr (policies.worklist == Worklist::active) {
            marker.mark(segments_of_disc[i]);
        }
    };
    Changes changes;
    const int* first_contact = strip.contact_begin.data();
    const BoxRange rows = state.grid.rows_of_strip(index, strip_height(policies.order));
    for (int row = rows.first; row <= rows.last; ++row, first_contact += state.active.per_row()) {
        changes += resolve_row(state, strip, row, first_contact, approaching, on_change);
    }
    return changes;
}

} // namespace carom
