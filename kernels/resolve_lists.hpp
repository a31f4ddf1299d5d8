#pragma once

#include <cstddef>
#include <iterator>
#include <unordered_set>
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

/// A part of a disc's list of partners that is still to be gone through.
struct Partners {
    const int* first;
    const int* last;

    explicit Partners(const std::vector<int>& list) : first(list.data()), last(list.data() + list.size()) {}

    bool empty() const { return first == last; }
    int size() const { return static_cast<int>(last - first); }

    /// The next one in the given direction.
    template <Direction direction> int next() const {
        return direction == Direction::reverse ? last[-1] : *first;
    }
    template <Direction direction> void take() {
        if constexpr (direction == Direction::reverse) {
            --last;
        } else {
            ++first;
        }
    }
};

/// Goes through `partners` up to the next that approaches `disc`, or to their end.
template <Direction direction, class Real>
[[gnu::always_inline]] inline void find_approaching(const BasicDisc<Real>& disc, const BasicDisc<Real>* discs,
                                                    Partners& partners) {
    using Both = BothComponents<Real>;
    const auto position = Both::load_position(disc);
    const auto velocity = Both::load_velocity(disc);
    for (; !partners.empty(); partners.take<direction>()) {
        const BasicDisc<Real>& partner = discs[partners.next<direction>()];
        const auto towards = position - Both::load_position(partner);
        if (Both::sum((velocity - Both::load_velocity(partner)) * towards) < 0) {
            break;
        }
    }
}

/// The visit of a disc at a wall or with an approaching partner, the next of `partners`.
template <bool again, Direction direction, Policies policies, class OnPartner>
[[gnu::noinline]] Changes visit_from(State<policies>& state, int i, Partners partners, bool at_wall,
                                     const ApproachOf<policies>& approaching, const OnPartner& on_partner) {
    Changes changes;
    auto* const discs = state.discs.data();
    auto& disc = discs[i];
    const Partners all(state.overlaps[static_cast<std::size_t>(i)]);
    for (int pass = 0; pass < (again ? passes_per_visit : 1); ++pass) {
        const int before = changes.count();
        changes.attempts += all.size();
        while (!partners.empty()) {
            const int j = partners.next<direction>();
            if (resolve_pair(disc, discs[j], approaching)) {
                ++changes.pairs;
                on_partner(j);
            }
            partners.take<direction>();
            find_approaching<direction>(disc, discs, partners);
        }
        if (at_wall) {
            changes.walls += resolve_walls(disc, state.side, state.radius);
        }
        if (changes.count() == before) {
            break;
        }
        partners = all;
        find_approaching<direction>(disc, discs, partners);
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
    const auto* const discs = state.discs.data();
    const Partners all(state.overlaps[static_cast<std::size_t>(i)]);
    Partners partners = all;
    find_approaching<direction>(discs[i], discs, partners);
    if (partners.empty() && !at_wall) [[likely]] {
        return {.attempts = all.size()};
    }
    return visit_from<again, direction>(state, i, partners, at_wall, approaching, on_partner);
}

inline constexpr auto ignore_partner = [](int) {};

/// Asks for what the visits of a box will read, so that they do not wait for one cache line after another.
template <Policies policies> void prefetch_box(const State<policies>& state, int row, int column) {
    for (const int i : state.discs_in(row, column)) {
        __builtin_prefetch(&state.overlaps[static_cast<std::size_t>(i)]);
        __builtin_prefetch(&state.discs[static_cast<std::size_t>(i)]);
    }
    for (const int i : state.discs_in(row, column)) {
        __builtin_prefetch(state.overlaps[static_cast<std::size_t>(i)].data());
    }
}

template <Policies policies>
Changes resolve_box(State<policies>& state, int row, int column, const ApproachOf<policies>& approaching) {
    Changes changes;
    prefetch_box(state, row, column);
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
