#pragma once

#include <cstddef>
#include <iterator>
#include <unordered_set>
#include <vector>

#include "collide.hpp"
#include "look_ahead.hpp"
#include "policies.hpp"
#include "state.hpp"
#include "tally.hpp"

namespace carom {

/// Whether a visit to a disc looks at its walls, too, after its list.
enum class LookAtWalls { yes, no };

/// Does disc i overlap a wall that a visit looks at?
template <LookAtWalls walls, Policies policies> bool looks_at_wall(const State<policies>& state, int i) {
    return walls == LookAtWalls::yes && state.overlaps_wall[static_cast<std::size_t>(i)] != 0;
}

/// Visits disc i: passes over its list of overlaps, and then its walls if `at_wall`, one pass or, with
/// `again`, until a pass changes nothing. `on_partner(j)` is called for each partner changed.
template <bool again, Direction direction, Policies policies, class OnPartner>
[[gnu::always_inline]] inline Changes visit(State<policies>& state, int i, bool at_wall,
                                            const ApproachToleranceOf<policies>& approaching,
                                            const OnPartner& on_partner) {
    auto* const discs = state.discs.data();
    constexpr bool reverse = direction == Direction::reverse;
    const std::vector<int>& partners = state.overlaps[static_cast<std::size_t>(i)];
    const int* const first = partners.data();
    const int* const last = first + partners.size();
    DiscInRegisters<RealOf<policies.precision>> disc(discs[i]);
    Changes changes;
    for (int pass = 0; pass < (again ? passes_per_visit : 1); ++pass) {
        const int before = changes.count();
        changes.attempts += static_cast<int>(partners.size());
        const int* next = reverse ? last : first;
        while (next != (reverse ? first : last)) {
            const int j = reverse ? *--next : *next++;
            if (resolve_pair(disc, discs[j], approaching)) {
                ++changes.pairs;
                on_partner(j);
            }
        }
        if (changes.count() > before) {
            disc.store_velocity(discs[i]);
        }
        if (at_wall) [[unlikely]] {
            changes.walls += resolve_walls(discs[i], state.side, state.radius);
            disc = DiscInRegisters(discs[i]);
        }
        if (changes.count() == before) {
            break;
        }
    }
    return changes;
}

inline constexpr auto ignore_partner = [](int) {};

template <Policies policies>
Changes resolve_box(State<policies>& state, int row, int column,
                    const ApproachToleranceOf<policies>& approaching) {
    Changes changes;
    const bool at_wall = state.grid.at_wall(row, column);
    for (const int i : state.discs_in(row, column)) {
        changes += visit<true, policies.direction>(
            state, i, at_wall && looks_at_wall<LookAtWalls::yes>(state, i), approaching, ignore_partner);
    }
    return changes;
}

/// What one strip of rows does in a sweep.
template <Policies policies>
    requires(policies.overlaps == Overlaps::lists)
Changes resolve_strip(State<policies>& state, int strip, const ApproachToleranceOf<policies>& approaching) {
    Changes changes;
    const BoxRange rows = state.grid.rows_of_strip(strip, strip_height(policies.order));
    for (int row = rows.first; row <= rows.last; ++row) {
        for (int column = 0; column < state.grid.boxes_per_side(); ++column) {
            look_ahead_to_resolve(state, row, column, 1);
            changes += resolve_box(state, row, column, approaching);
        }
    }
    return changes;
}

/// Discs to visit again, because another one changed them: in the order in which it did, and as often.
struct Remembered {
    std::vector<int> now;
    std::vector<int> next;

    /// What was remembered is what is visited now. Of more than two visits a disc of `discs` (and some more),
    /// each disc keeps its first: discs wedged between walls would be remembered a hundred times as often
    /// each time. The published program has no such limit; none of its known states needs more than one visit
    /// a disc.
    void begin_round(int discs) {
        constexpr int some_more = 100;
        now.swap(next);
        next.clear();
        if (std::ssize(now) > 2 * std::ptrdiff_t{discs} + some_more) [[unlikely]] {
            std::unordered_set<int> seen;
            std::erase_if(now, [&seen](int i) { return !seen.insert(i).second; });
        }
    }
};

/// Visits each of `discs` in turn and remembers partners before it that it changed. Returns the sum of what
/// the visits changed: of all discs, a Tally.
template <class Sum, LookAtWalls walls, Policies policies, class Discs>
Sum visit_each(State<policies>& state, const Discs& discs, Remembered& remembered,
               const ApproachToleranceOf<policies>& approaching) {
    Sum total;
    remembered.next.clear();
    for (const int i : discs) {
        const Changes changes = visit<true, policies.direction>(state, i, looks_at_wall<walls>(state, i),
                                                                approaching, [&](int j) {
                                                                    if (j < i) {
                                                                        remembered.next.push_back(j);
                                                                    }
                                                                });
        total += changes;
        if (changes.count() >= passes_per_visit) {
            remembered.next.push_back(i);
        }
    }
    return total;
}

/// Visits what was remembered, and remembers every partner changed.
template <class Sum, LookAtWalls walls, Policies policies>
Sum visit_remembered(State<policies>& state, Remembered& remembered,
                     const ApproachToleranceOf<policies>& approaching) {
    Sum total;
    remembered.begin_round(state.count());
    for (const int i : remembered.now) {
        const Changes changes =
            visit<true, Direction::forward>(state, i, looks_at_wall<walls>(state, i), approaching,
                                            [&](int j) { remembered.next.push_back(j); });
        total += changes;
        if (changes.count() >= passes_per_visit) {
            remembered.next.push_back(i);
        }
    }
    return total;
}

} // namespace carom
