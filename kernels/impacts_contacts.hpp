#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <vector>

#include "collide.hpp"
#include "contacts.hpp"
#include "find_contacts.hpp"
#include "four_at_once.hpp"
#include "parallel_for.hpp"
#include "policies.hpp"
#include "resolve_contacts.hpp"
#include "state.hpp"
#include "sweep.hpp"
#include "tally.hpp"
#include "wavefront.hpp"
#include "way_back.hpp"

namespace carom {

/// Writes those near pairs of one row's active blocks to `asked` of which a disc has collided in the sweep
/// before; in the first sweep, all. Returns its end.
template <Policies policies>
int* pairs_to_ask(State<policies>& state, Strip<RealOf<policies.precision>>& strip, int row,
                  const int* first_pair, int sweep, int* asked, int& attempts) {
    const auto* const near = strip.near.data();
    const auto* const changed_in = state.changed_in.data();
    unsigned char* const marks = state.active.row(row);
    const int* const last = active_blocks(marks, state.active.per_row(), strip.blocks_to_look_at.data());
    for (const int* block = strip.blocks_to_look_at.data(); block != last;) {
        int k = first_pair[*block];
        int end = k; // of a run of blocks: how many pairs one of them has, no processor can predict
        for (; block != last && first_pair[*block] == end; ++block) {
            marks[*block] = 0;
            end = first_pair[*block + 1];
        }
        attempts += end - k;
        for (; sweep == 0 && k < end; ++k) {
            *asked++ = k;
        }
        for (; k < end; ++k) {
            const auto [first, second] = near[k].discs;
            *asked = k;
            asked += std::max(changed_in[first], changed_in[second]) == sweep - 1;
        }
    }
    return asked;
}

/// Of some near pairs, given by their numbers, keeps those that have come into contact; returns the new end.
/// Disc and wall are asked later.
template <Policies policies>
int* keep_met(const State<policies>& state, const Strip<RealOf<policies.precision>>& strip, int* begin,
              const int* end, const WayBack<RealOf<policies.precision>>& its_back) {
    const auto back = its_back; // copies: what is written could alias them
    const auto reach_squared = state.reach_squared();
    const auto* const near = strip.near.data();
    const auto* const discs = state.discs.data();
    int* met = begin;
    for (const int* k = begin; k < end; k += 2) {
        const bool are_two = k + 1 < end;
        const std::array<int, 2> asked{k[0], k[are_two ? 1 : 0]};
        const std::array<OverlappingDiscs, 2> pairs{near[asked[0]].discs, near[asked[1]].discs};
        const auto have_met = motions_of_two(pairs, discs, reach_squared).met(back);
        *met = asked[0];
        met += (have_met[0] != 0) | pairs[0].at_wall();
        *met = asked[1];
        met += ((have_met[1] != 0) | pairs[1].at_wall()) & are_two;
    }
    return met;
}

/// Drops the pending collisions of a strip of which a disc has collided in the sweep before; returns the end
/// of those that are left.
template <Policies policies>
int* keep_pending(const State<policies>& state, Strip<RealOf<policies.precision>>& strip, int sweep) {
    const auto* const changed_in = state.changed_in.data();
    int* kept = strip.pending.data();
    for (int n = 0; n < strip.pending_count; ++n) {
        const int k = strip.pending[static_cast<std::size_t>(n)];
        const auto [first, second] = strip.near[static_cast<std::size_t>(k)].discs;
        *kept = k;
        kept += std::max(changed_in[first], changed_in[second]) != sweep - 1;
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
        found = pairs_to_ask(state, strip, row, first_pair, sweep, found, changes.attempts);
    }
    found = keep_met(state, strip, strip.colliding.data(), found, back);
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
template <Policies policies, class SomeProbe>
Changes collide_earliest(State<policies>& state, int index, int sweep,
                         const WayBack<RealOf<policies.precision>>& back,
                         const ApproachToleranceOf<policies>& approaching, SomeProbe& probe) {
    Changes changes;
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    auto* const changed_in = state.changed_in.data();
    const auto* const blocks_of_disc = state.blocks_of_disc.data();
    const auto marker = state.active.marker();
    const int* const end = take_earliest(state, strip);
    for (const int* k = strip.colliding.data(); k != end; ++k) {
        auto& pair = strip.near[static_cast<std::size_t>(*k)];
        const auto [first, second] = pair.discs;
        if (changed_in[first] == sweep || changed_in[second] == sweep) [[unlikely]] {
            strip.pending[static_cast<std::size_t>(strip.pending_count++)] = *k;
            continue;
        }
        const Changes made = collide_at(pair.time, state, pair.discs, back, approaching);
        tell(made, pair.time, sweep, state, pair.discs, probe);
        changes += made;
        for (const int disc : {first, second}) {
            changed_in[disc] = sweep;
            marker.mark(blocks_of_disc[disc]);
        }
        pair.last = pair.time;
    }
    return changes;
}

/// Writes those of the near pairs [begin, end) that overlap now, or are a disc and a wall, to `found`, beyond
/// whose end there must be room for one; returns that end.
template <Policies policies>
int* overlapping_now(const State<policies>& state, const Strip<RealOf<policies.precision>>& strip, int begin,
                     int end, int* found) {
    using Both = BothComponents<RealOf<policies.precision>>;
    const auto reach_squared = state.reach_squared();
    const auto* const near = strip.near.data();
    const auto* const discs = state.discs.data();
    const auto distance = [&](int k) {
        return Both::load_position(discs[near[k].discs.second]) -
               Both::load_position(discs[near[k].discs.first]);
    };
    for (int k = begin; k < end; k += 2) {
        const auto one = distance(k);
        const auto other = distance(std::min(k + 1, end - 1));
        const auto apart = sums(one * one, other * other) > reach_squared;
        *found = k;
        found += apart[0] == 0;
        *found = k + 1;
        found += (apart[1] == 0) & (k + 1 < end);
    }
    return found;
}

/// Makes contacts of the near pairs of a strip that overlap now, and marks the blocks that have some.
template <Policies policies> void make_contacts(State<policies>& state, int index) {
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    const BoxRange rows = state.grid.rows_of_strip(index, strip_height(policies.order));
    int pair = 0;
    int* begin = strip.block_begin.data();
    for (int row = rows.first; row <= rows.last; ++row) {
        for (int block = 0; block < state.active.per_row(); ++block, ++begin) {
            const int end = begin[1];
            *begin = static_cast<int>(strip.contacts.size());
            int* const overlapping = strip.colliding.data();
            const int* const last = overlapping_now(state, strip, pair, end, overlapping);
            for (const int* k = overlapping; k != last; ++k) {
                add_contact(state, strip.near[static_cast<std::size_t>(*k)].discs, strip);
            }
            pair = end;
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
    const int strips = state.grid.strip_count(strip_height(policies.order));
    const std::vector<StripSweep> order = sweep_order(strips, 2, strips);
    Wavefront wavefront(strips);
    return sweep_impacts(tuning, probe, [&](int sweep, int threads) {
        return parallel_for<policies.resolve_schedule>(
            threads, static_cast<int>(order.size()), tuning.resolve_chunk, probe,
            [&](int index) {
                const auto [strip, half] = order[static_cast<std::size_t>(index)];
                const Changes changes = half == 0
                                            ? look_back(state, strip, sweep, back)
                                            : collide_earliest(state, strip, sweep, back, approaching, probe);
                wavefront.ends(strip, 2 * sweep + half);
                return Tally(changes);
            },
            [&](int index) {
                const auto [strip, half] = order[static_cast<std::size_t>(index)];
                return wavefront.can_begin(strip, 2 * sweep + half);
            });
    });
}

} // namespace carom
