#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "contacts.hpp"
#include "find_contacts.hpp"
#include "parallel_for.hpp"
#include "policies.hpp"
#include "resolve_contacts.hpp"
#include "state.hpp"
#include "sweep.hpp"
#include "tally.hpp"
#include "wavefront.hpp"
#include "way_back.hpp"

namespace carom {

/// Adds to `found` those near pairs of one row's active blocks that have come into contact, if one of the two
/// has collided in the sweep before; in the first sweep, all. Disc and wall are asked later. Returns its end.
template <Policies policies>
int* look_back_in_row(State<policies>& state, Strip<RealOf<policies.precision>>& strip, int row,
                      const int* first_pair, int sweep, const WayBack<RealOf<policies.precision>>& its_back,
                      int* found, int& attempts) {
    const auto back = its_back; // copies: what is written could alias them
    const auto reach_squared = state.reach_squared();
    const auto* const near = strip.near.data();
    const auto* const discs = state.discs.data();
    const auto* const earliest = state.earliest.data();
    unsigned char* const marks = state.active.row(row);
    const int* const last = active_blocks(marks, state.active.per_row(), strip.blocks_to_look_at.data());
    for (const int* block = strip.blocks_to_look_at.data(); block != last; ++block) {
        marks[*block] = 0;
        attempts += first_pair[*block + 1] - first_pair[*block];
        for (int k = first_pair[*block]; k < first_pair[*block + 1]; ++k) {
            const auto [first, second] = near[k].discs;
            if (std::max(earliest[first].changed_in, earliest[second].changed_in) != sweep - 1) {
                continue;
            }
            const RelativeMotion motion(discs[first], discs[second], reach_squared);
            *found = k;
            found += motion.met(back) | (first == second);
        }
    }
    return found;
}

/// Drops the pending collisions of a strip of which a disc has collided in the sweep before; returns the end
/// of those that are left.
template <Policies policies>
int* keep_pending(const State<policies>& state, Strip<RealOf<policies.precision>>& strip, int sweep) {
    const auto* const earliest = state.earliest.data();
    int* kept = strip.pending.data();
    for (int n = 0; n < strip.pending_count; ++n) {
        const int k = strip.pending[static_cast<std::size_t>(n)];
        const auto [first, second] = strip.near[static_cast<std::size_t>(k)].discs;
        *kept = k;
        kept += std::max(earliest[first].changed_in, earliest[second].changed_in) != sweep - 1;
    }
    return kept;
}

/// Finds the collisions that are pending in a strip: those that were so far, if neither disc has collided
/// since, and those that have become so. Then lets the discs know when they are.
template <Policies policies>
Changes look_back(State<policies>& state, int index, int sweep,
                  const WayBack<RealOf<policies.precision>>& back) {
    Changes changes;
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    auto* const near = strip.near.data();
    int* pending = keep_pending(state, strip, sweep);
    int* found = strip.colliding.data();
    const int* first_pair = strip.block_begin.data();
    const BoxRange rows = state.grid.rows_of_strip(index, strip_height(policies.order));
    for (int row = rows.first; row <= rows.last; ++row, first_pair += state.active.per_row()) {
        found = look_back_in_row(state, strip, row, first_pair, sweep, back, found, changes.attempts);
    }
    for (const int* k = strip.colliding.data(); k != found; ++k) {
        auto& pair = near[*k];
        pair.time = time_of(pair.discs, state, back);
        *pending = *k;
        pending += (pair.time >= 0) & (pair.time < pair.last);
    }
    strip.pending_count = static_cast<int>(pending - strip.pending.data());
    for (const int* k = strip.pending.data(); k != pending; ++k) {
        for (const int disc : {near[*k].discs.first, near[*k].discs.second}) {
            auto& known = state.earliest[static_cast<std::size_t>(disc)];
            known.time = std::max(known.known_in == sweep ? known.time : 0, near[*k].time);
            known.known_in = sweep;
        }
    }
    return changes;
}

/// Moves those pending collisions of a strip that are the earliest known of both discs to `colliding`;
/// returns its end.
template <Policies policies>
int* take_earliest(const State<policies>& state, Strip<RealOf<policies.precision>>& strip) {
    const auto* const near = strip.near.data();
    const auto* const earliest = state.earliest.data();
    int* const pending = strip.pending.data();
    int* colliding = strip.colliding.data();
    int left = 0;
    for (int n = 0; n < strip.pending_count; ++n) {
        const int k = pending[n];
        const auto [first, second] = near[k].discs;
        const bool is_earliest =
            (near[k].time >= earliest[first].time) & (near[k].time >= earliest[second].time);
        *colliding = k;
        pending[left] = k;
        colliding += is_earliest;
        left += !is_earliest;
    }
    strip.pending_count = left;
    return colliding;
}

/// Makes the collisions of a strip whose turn in time has come.
template <Policies policies>
Changes collide_earliest(State<policies>& state, int index, int sweep,
                         const WayBack<RealOf<policies.precision>>& back,
                         const ApproachToleranceOf<policies>& approaching) {
    Changes changes;
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    auto* const earliest = state.earliest.data();
    const auto* const blocks_of_disc = state.blocks_of_disc.data();
    const auto marker = state.active.marker();
    const int* const end = take_earliest(state, strip);
    for (const int* k = strip.colliding.data(); k != end; ++k) {
        auto& pair = strip.near[static_cast<std::size_t>(*k)];
        const auto [first, second] = pair.discs;
        if (earliest[first].changed_in == sweep || earliest[second].changed_in == sweep) [[unlikely]] {
            strip.pending[static_cast<std::size_t>(strip.pending_count++)] = *k;
            continue;
        }
        changes += collide_at(pair.time, state, pair.discs, back, approaching);
        for (const int disc : {first, second}) {
            earliest[disc].changed_in = sweep;
            marker.mark(blocks_of_disc[disc]);
        }
        pair.last = pair.time;
    }
    return changes;
}

/// Makes contacts of the near pairs of a strip that overlap now, and marks the blocks that have some.
template <Policies policies> void make_contacts(State<policies>& state, int index) {
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    const BoxRange rows = state.grid.rows_of_strip(index, strip_height(policies.order));
    auto pair = strip.near.begin();
    int* begin = strip.block_begin.data();
    for (int row = rows.first; row <= rows.last; ++row) {
        for (int block = 0; block < state.active.per_row(); ++block, ++begin) {
            const int end = begin[1];
            *begin = static_cast<int>(strip.contacts.size());
            for (; pair != strip.near.begin() + end; ++pair) {
                add_contact(state, pair->discs, strip);
            }
            state.active.row(row)[block] = std::ssize(strip.contacts) > *begin;
        }
    }
    *begin = static_cast<int>(strip.contacts.size());
    strip.colliding.resize(strip.contacts.size() + 4);
}

/// Makes contacts of what is still overlapping at the end of the step, a strip to an iteration.
template <Policies policies, class SomeProbe>
    requires(policies.overlaps == Overlaps::contacts)
Tally find_left(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    return parallel_for<policies.resolve_schedule>(tuning.threads,
                                                   state.grid.strip_count(strip_height(policies.order)),
                                                   tuning.resolve_chunk, probe, [&](int strip) {
                                                       make_contacts(state, strip);
                                                       return Tally{};
                                                   });
}

/// Takes collisions back to their time of contact, the earliest first, until none is left. The discs' places
/// change; `find` has found what is near each other.
///
/// Strips take turns as in a wavefront, two a sweep: what they write is known of, or done to, their own discs
/// and those of the next one's first row (resolve_contacts.hpp).
template <Policies policies, class SomeProbe>
    requires(policies.overlaps == Overlaps::contacts)
Tally collide_at_contact(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    const auto back = way_back(state, tuning);
    const ApproachToleranceOf<policies> approaching(tuning.tolerance);
    const StripTurns turns(state.grid.strip_count(strip_height(policies.order)));
    Wavefront wavefront(turns.strips);
    return sweep_impacts(tuning, probe, [&](int sweep, int threads) {
        return parallel_for<policies.resolve_schedule>(
            threads, 2 * turns.strips, tuning.resolve_chunk, probe,
            [&](int turn) {
                const int strip = turns.strip(turn);
                const bool looks = turns.sweep(turn) == 0;
                const Changes changes = looks ? look_back(state, strip, sweep, back)
                                              : collide_earliest(state, strip, sweep, back, approaching);
                wavefront.ends(strip, 2 * sweep + turns.sweep(turn));
                return Tally(changes);
            },
            [&](int turn) { return wavefront.can_begin(turns.strip(turn), 2 * sweep + turns.sweep(turn)); });
    });
}

} // namespace carom
