#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <limits>

#include "at_contact.hpp"
#include "collide.hpp"
#include "contacts.hpp"
#include "find.hpp"
#include "four_at_once.hpp"
#include "look_ahead.hpp"
#include "parallel_for.hpp"
#include "policies.hpp"
#include "state.hpp"
#include "sweep.hpp"
#include "tally.hpp"
#include "threads/own_lines.hpp"

// Impact::at_contact with lists. Each near pair stands in two lists, and each disc chooses the earliest
// collision of its own. Two discs that choose each other collide.
//
// Why no two threads touch the same disc. While discs choose, positions and velocities are only read, and
// each disc's choice is written by who asks it. While they collide, choices are only read: a disc is in one
// pair at most of which both choose each other, and one thread alone makes the collision of that pair. It
// writes the two discs and their lists, which nobody else reads then, and marks discs that are to choose
// anew: an atomic store of one value, whoever comes first.
//
// Why some pair collides as long as there is one to: of those that are the earliest of all, at one instant,
// the lowest disc chooses its lowest partner, which chooses it.

namespace carom {

/// Chooses the collision of disc i that is to be made first: of those of this step, or of the one before if
/// that can have left them, the earliest that comes after the last one of the same two discs. Of several at
/// the same instant it is that with the disc of the lowest index.
template <Policies policies>
Changes choose_next(State<policies>& state, int i, const WayBackOf<policies>& back) {
    const auto& near = state.near[static_cast<std::size_t>(i)];
    const auto disc = state.disc(i);
    const auto reach_squared = state.reach_squared();
    NextCollision<RealOf<policies.precision>> next;
    for (int entry = 0; entry < std::ssize(near); ++entry) {
        const auto& [other, in_own_box, last] = near[static_cast<std::size_t>(entry)];
        const OverlappingDiscs discs{i, other};
        const auto& partner = state.disc(other);
        if (!discs.at_wall() && !motion_of(disc, partner, reach_squared).met(back)) {
            continue;
        }
        const auto time = time_of(discs, state, back);
        const bool pending = time >= 0 && time < last;
        if (pending && (time > next.time || (time == next.time && other < next.other))) {
            next = {time, other, entry};
        }
    }
    state.next[static_cast<std::size_t>(i)] = next;
    return {.attempts = static_cast<int>(near.size())};
}

/// Finds the discs within twice `radius` of each disc of one box, and those that are that near a wall, and
/// lets each choose. `tally.overlaps` is raised by how many of the lists' entries overlap their disc.
///
/// Any two boxes may run at the same time: of other boxes positions and velocities are only read, which
/// nobody writes.
template <Policies policies>
void find_near_in_box(State<policies>& state, int row, int column, RealOf<policies.precision> radius,
                      const WayBackOf<policies>& back, Tally& tally) {
    using Real = RealOf<policies.precision>;
    const Real near_squared = (2 * radius) * (2 * radius);
    const bool at_wall = state.grid.at_wall(row, column);
    const auto add = [&](int i, int j, bool in_own_box) {
        constexpr Real never = std::numeric_limits<Real>::infinity();
        state.near[static_cast<std::size_t>(i)].push_back({j, in_own_box, never});
        tally.overlaps += i != j && overlap(state.disc(i), state.disc(j), state.reach_squared());
    };
    for (const int i : state.discs_in(row, column)) {
        state.near[static_cast<std::size_t>(i)].clear();
    }
    for_each_pair_within(state, row, column, near_squared, [&](int i, int j) {
        add(i, j, true);
        add(j, i, true);
    });
    for (const int i : state.discs_in(row, column)) {
        const auto disc = static_cast<std::size_t>(i);
        for_each_other_beyond(state, i, row, column, near_squared, [&](int j) { add(i, j, false); });
        state.overlaps_wall[disc] = at_wall && overlaps_wall(state.discs[disc], state.side, radius);
        if (state.overlaps_wall[disc] != 0) [[unlikely]] {
            add(i, i, true);
        }
        state.asked[disc] = 1;
        state.asked_next[disc] = 0;
        tally += choose_next(state, i, back);
    }
}

/// Finds what is near each disc, a box to an iteration.
template <Policies policies, class SomeProbe>
    requires(policies.overlaps == Overlaps::lists && policies.impact == Impact::at_contact)
Tally find(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    state.near.resize(state.discs.size());
    state.next.resize(state.discs.size());
    state.asked.resize(state.discs.size());
    state.asked_next.resize(state.discs.size());
    state.steps_flown = std::min(state.steps_flown + 1, 2);
    const auto back = way_back(state, tuning);
    const auto radius = state.search_radius(back.step);
    const int boxes_per_side = state.grid.boxes_per_side();
    Tally tally = parallel_for_boxes<policies.find_schedule, Tally>(
        tuning.threads, boxes_per_side, boxes_per_side, tuning.find_chunk, probe,
        [&](int row, int column, Tally& sum) {
            look_ahead_to_find(state, row, column);
            if (!state.is_empty(row, column)) {
                find_near_in_box(state, row, column, radius, back, sum);
            }
        });
    tally.overlaps /= 2; // each pair stands in two lists
    return tally;
}

/// Discs whose marks share a cache line: what a thread takes at a time.
inline constexpr int discs_at_once = cache_line;

/// Runs `body(i)` for every disc that is asked in this sweep, in the order of storage, and returns the sum of
/// what it changed. `begin(first, last)` is called before, for every range of discs.
template <Policies policies, class SomeProbe, class Begin, class Body>
Tally for_each_asked(const State<policies>& state, int threads, const Tuning& tuning, SomeProbe& probe,
                     const Begin& begin, const Body& body) {
    const int count = state.count();
    return parallel_for<policies.resolve_schedule>(
        threads, (count + discs_at_once - 1) / discs_at_once, tuning.resolve_chunk, probe, [&](int range) {
            const int first = range * discs_at_once;
            const int last = std::min(first + discs_at_once, count);
            begin(first, last);
            std::array<int, discs_at_once + 1> room;
            Selection asked(room);
            for (int i = first; i < last; ++i) {
                asked.add_if(state.asked[static_cast<std::size_t>(i)], i);
            }
            Changes changes;
            for (const int i : asked) {
                changes += body(i);
            }
            return Tally(changes);
        });
}

/// Has disc i and all that are near it choose anew in the next sweep.
template <Policies policies> void ask_again(State<policies>& state, int i) {
    const auto ask = [&state](int j) {
        std::atomic_ref(state.asked_next[static_cast<std::size_t>(j)]).store(1, std::memory_order_relaxed);
    };
    ask(i);
    for (const auto& near : state.near[static_cast<std::size_t>(i)]) {
        ask(near.other);
    }
}

/// Makes the collision that disc i, which was asked, has chosen, if the other disc has chosen the same one.
/// If both were asked, it is made when the first of them comes up.
template <Policies policies, class SomeProbe>
Changes collide_if_both_choose(State<policies>& state, int i, int sweep, const WayBackOf<policies>& back,
                               const ApproachToleranceOf<policies>& approaching, SomeProbe& probe) {
    const auto [time, other, entry] = state.next[static_cast<std::size_t>(i)];
    if (other < 0) {
        return {};
    }
    const auto partner = static_cast<std::size_t>(other);
    const auto its_choice = state.next[partner];
    if (its_choice.other != i || (other < i && state.asked[partner] != 0)) {
        return {};
    }
    const Changes changes = collide_at(time, state, {i, other}, back, approaching);
    tell(changes, time, sweep, state, {i, other}, probe);
    state.near[static_cast<std::size_t>(i)][static_cast<std::size_t>(entry)].last = time;
    state.near[partner][static_cast<std::size_t>(its_choice.entry)].last = time;
    ask_again(state, i);
    ask_again(state, other);
    return changes;
}

/// Puts those near discs of one box's discs that overlap them now into their lists of overlaps and, with
/// self-contained resolves, resolves within the box before it looks beyond, as `find_in_box` does.
template <Policies policies>
void find_left_in_box(State<policies>& state, int row, int column,
                      const ApproachToleranceOf<policies>& approaching, Tally& tally) {
    const auto reach_squared = state.reach_squared();
    const auto add_overlaps = [&](int i, bool in_own_box) {
        const auto& disc = state.disc(i);
        for (const auto& near : state.near[static_cast<std::size_t>(i)]) {
            if (near.in_own_box == in_own_box && near.other != i &&
                overlap(disc, state.disc(near.other), reach_squared)) {
                state.overlaps[static_cast<std::size_t>(i)].push_back(near.other);
            }
        }
    };
    for (const int i : state.discs_in(row, column)) {
        state.overlaps[static_cast<std::size_t>(i)].clear();
        add_overlaps(i, true);
    }
    if constexpr (policies.self_contained == SelfContained::on) {
        tally += resolve_within_box(state, row, column, approaching);
    }
    for (const int i : state.discs_in(row, column)) {
        add_overlaps(i, false);
    }
}

/// Finds the overlaps that are left at the end of the step, a box to an iteration.
template <Policies policies, class SomeProbe>
    requires(policies.overlaps == Overlaps::lists)
Tally find_left(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    const ApproachToleranceOf<policies> approaching(tuning.tolerance);
    const int boxes_per_side = state.grid.boxes_per_side();
    return parallel_for_boxes<policies.find_schedule, Tally>(
        tuning.threads, boxes_per_side, boxes_per_side, tuning.find_chunk, probe,
        [&](int row, int column, Tally& sum) {
            look_ahead_to_find_left(state, row, column);
            if (!state.is_empty(row, column)) {
                find_left_in_box(state, row, column, approaching, sum);
            }
        });
}

/// Takes collisions back to their time of contact, the earliest first, until none is left. The discs' places
/// change; `find` has found what is near each other.
template <Policies policies, class SomeProbe>
    requires(policies.overlaps == Overlaps::lists)
Tally collide_at_contact(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    const auto back = way_back(state, tuning);
    const ApproachToleranceOf<policies> approaching(tuning.tolerance);
    return sweep_at_contact(tuning, probe, [&](int sweep, int threads) {
        Tally work;
        if (sweep > 0) { // `find` has asked them for the first
            state.asked.swap(state.asked_next);
            const auto begin = [&](int first, int last) {
                std::fill_n(state.asked_next.begin() + first, last - first, static_cast<unsigned char>(0));
            };
            work += for_each_asked(state, threads, tuning, probe, begin,
                                   [&](int i) { return choose_next(state, i, back); });
        }
        work += for_each_asked(
            state, threads, tuning, probe, [](int, int) {},
            [&](int i) { return collide_if_both_choose(state, i, sweep, back, approaching, probe); });
        return work;
    });
}

} // namespace carom
