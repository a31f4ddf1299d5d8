#pragma once

#include <cstddef>
#include <vector>

#include "collide.hpp"
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

/// A way through a list: `first`, then by `step` to `end`.
struct Way {
    int first;
    int step;
    int end;
};

template <Direction direction> Way way_through(const std::vector<int>& list) {
    const int size = static_cast<int>(list.size());
    return direction == Direction::reverse ? Way{size - 1, -1, -1} : Way{0, 1, size};
}

/// From place `k` of a list of partners, the next place whose disc approaches `disc`, or `way.end`. Hardly
/// any does: so the search has no branch but that one.
template <class Real>
[[gnu::always_inline]] inline int next_approaching(const BasicDisc<Real>& disc, const BasicDisc<Real>* discs,
                                                   const int* partners, int k, const Way& way) {
    using Both = BothComponents<Real>;
    const auto position = Both::load_position(disc);
    const auto velocity = Both::load_velocity(disc);
    for (; k != way.end; k += way.step) {
        const BasicDisc<Real>& partner = discs[partners[k]];
        const auto towards = position - Both::load_position(partner);
        if (Both::sum((velocity - Both::load_velocity(partner)) * towards) < 0) {
            break;
        }
    }
    return k;
}

/// The visit of a disc at a wall or with an approaching partner, the first of them at place `k` of its list.
template <bool again, Direction direction, Policies policies, class OnPartner>
[[gnu::noinline]] Changes visit_from(State<policies>& state, int i, int k, bool at_wall,
                                     const ApproachOf<policies>& approaching, const OnPartner& on_partner) {
    Changes changes;
    auto* const discs = state.discs.data();
    const std::vector<int>& overlaps = state.overlaps[static_cast<std::size_t>(i)];
    const Way way = way_through<direction>(overlaps);
    for (int pass = 0; pass < (again ? passes_per_visit : 1); ++pass) {
        const int before = changes.count();
        changes.attempts += static_cast<int>(overlaps.size());
        for (; k != way.end; k = next_approaching(discs[i], discs, overlaps.data(), k + way.step, way)) {
            const int j = overlaps[static_cast<std::size_t>(k)];
            if (resolve_pair(discs[i], discs[j], approaching)) {
                ++changes.pairs;
                on_partner(j);
            }
        }
        if (at_wall) {
            changes.walls += resolve_walls(discs[i], state.side, state.radius);
        }
        if (changes.count() == before) {
            break;
        }
        k = next_approaching(discs[i], discs, overlaps.data(), way.first, way);
    }
    return changes;
}

/// Visits disc i: passes over its list of overlaps, and then its walls if `at_wall`, one pass or, with
/// `again`, until a pass changes nothing. `on_partner(j)` is called for each partner changed. Most visits
/// change nothing and end with the first look.
template <bool again, Direction direction, Policies policies, class OnPartner>
[[gnu::always_inline]] inline Changes visit(State<policies>& state, int i, bool at_wall,
                                            const ApproachOf<policies>& approaching,
                                            const OnPartner& on_partner) {
    const std::vector<int>& overlaps = state.overlaps[static_cast<std::size_t>(i)];
    const Way way = way_through<direction>(overlaps);
    const auto* const discs = state.discs.data();
    const int k = next_approaching(discs[i], discs, overlaps.data(), way.first, way);
    if (k == way.end && !at_wall) [[likely]] {
        return {.attempts = static_cast<int>(overlaps.size())};
    }
    return visit_from<again, direction>(state, i, k, at_wall, approaching, on_partner);
}

inline constexpr auto ignore_partner = [](int) {};

template <Policies policies>
Changes resolve_box(State<policies>& state, int row, int column, const ApproachOf<policies>& approaching) {
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

/// Discs to visit again, because another one changed them: in the order in which it did, and as often.
struct Remembered {
    std::vector<int> now;
    std::vector<int> next;
};

/// Visits each of `discs` in turn and remembers partners before it that it changed.
template <LookAtWalls walls, Policies policies, class Discs>
Changes visit_each(State<policies>& state, const Discs& discs, Remembered& remembered,
                   const ApproachOf<policies>& approaching) {
    Changes total;
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
template <LookAtWalls walls, Policies policies>
Changes visit_remembered(State<policies>& state, Remembered& remembered,
                         const ApproachOf<policies>& approaching) {
    Changes total;
    remembered.now.swap(remembered.next);
    remembered.next.clear();
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
