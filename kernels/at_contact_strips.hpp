#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <iterator>

#include "at_contact.hpp"
#include "collide.hpp"
#include "contacts.hpp"
#include "find_contacts.hpp"
#include "four_at_once.hpp"
#include "parallel_for.hpp"
#include "policies.hpp"
#include "resolve_contacts.hpp"
#include "state.hpp"
#include "storage.hpp"
#include "sweep.hpp"
#include "tally.hpp"
#include "wavefront.hpp"

// The sweeps of Impact::at_contact. Each near pair is known of one strip, in a list by segments as contacts
// are. A sweep has two halves. In the first a strip finds which of its near pairs are pending: of those of
// which a disc has collided in the sweep before, those that have met; and each disc learns when the earliest
// of its pending collisions was. In the second those collisions are made that are the earliest of both discs.
// What then still overlaps becomes contacts, which are resolved in place.

namespace carom {

/// The last sweep in which one of two discs has collided; -1 before the first.
inline int last_change(OverlappingDiscs discs, const int* changed_in) {
    return std::max(changed_in[discs.first], changed_in[discs.second]);
}

/// Keeps those pending of which no disc has collided in the sweep before.
template <Policies policies>
Selection keep_pending(const State<policies>& state, StripOf<policies>& strip, int sweep) {
    const auto* const near = strip.near.data();
    const auto* const changed_in = state.changed_in.data();
    Selection pending(strip.pending);
    for (const int k : strip.pending_pairs()) {
        pending.add_if(last_change(near[k].discs, changed_in) != sweep - 1, k);
    }
    return pending;
}

/// The near pairs of segments that follow one another in memory, from `segment` on, which is moved beyond the
/// last of them: how many one segment has, no processor can predict. The segments are active no longer.
inline Indices take_run(const int*& segment, const int* end, const int* near_begin, unsigned char* marks) {
    Indices run{near_begin[*segment], near_begin[*segment]};
    for (; segment != end && near_begin[*segment] == run.last; ++segment) {
        marks[*segment] = 0;
        run.last = near_begin[*segment + 1];
    }
    return run;
}

/// Adds those near pairs of one row's active segments to `asked` of which a disc has collided in the sweep
/// before; in the first sweep, all. Returns how many were looked at. `near_begin` is that of the row's first
/// segment.
template <Policies policies>
[[gnu::always_inline]] inline int add_to_ask(State<policies>& state, StripOf<policies>& strip, int row,
                                             const int* near_begin, int sweep, Selection& asked) {
    const auto* const near = strip.near.data();
    const auto* const changed_in = state.changed_in.data();
    unsigned char* const marks = state.active.row(row);
    const Selection active = active_segments(marks, state.active.per_row(), strip.segments);
    int looked_at = 0;
    for (const int* segment = active.begin(); segment != active.end();) {
        const Indices run = take_run(segment, active.end(), near_begin, marks);
        looked_at += run.count();
        if (sweep == 0) {
            for (const int k : run) {
                asked.add_if(1, k);
            }
        } else {
            for (const int k : run) {
                asked.add_if(last_change(near[k].discs, changed_in) == sweep - 1, k);
            }
        }
    }
    return looked_at;
}

/// The near pairs of a strip that are to be asked whether they have met. `attempts` is raised by how many
/// were looked at.
template <Policies policies>
[[gnu::always_inline]] inline Selection pairs_to_ask(State<policies>& state, int index, int sweep,
                                                     int& attempts) {
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    const BoxRange rows = state.grid.rows_of_strip(index, strip_height(policies.order));
    const int* near_begin = strip.near_begin.data();
    Selection asked(strip.selected);
    for (int row = rows.first; row <= rows.last; ++row, near_begin += state.active.per_row()) {
        attempts += add_to_ask(state, strip, row, near_begin, sweep, asked);
    }
    return asked;
}

/// Of those asked, the near pairs that have come into contact. Discs at a wall are asked later.
template <Policies policies>
Selection have_met(const State<policies>& state, const StripOf<policies>& strip, Selection asked,
                   const WayBackOf<policies>& its_back) {
    const auto back = its_back; // copies: what is written could alias them
    const auto reach_squared = state.reach_squared();
    const auto* const near = strip.near.data();
    const auto* const discs = state.discs.data();
    Selection met = Selection::from(asked);
    for (const int* k = asked.begin(); k < asked.end(); k += 2) {
        const bool are_two = k + 1 < asked.end();
        const std::array<int, 2> both{k[0], k[are_two ? 1 : 0]};
        const std::array<OverlappingDiscs, 2> pairs{near[both[0]].discs, near[both[1]].discs};
        const auto they_met = motions_of_two(pairs, discs, reach_squared).met(back);
        met.add_if((they_met[0] != 0) | pairs[0].at_wall(), both[0]);
        met.add_if(((they_met[1] != 0) | pairs[1].at_wall()) & are_two, both[1]);
    }
    return met;
}

/// Lets both discs of each pending pair know of it, if they know of none before it in this sweep. Times are
/// counted back from the step's end: the earliest is the largest.
template <Policies policies>
void know_earliest(State<policies>& state, const StripOf<policies>& strip, int sweep) {
    const auto* const near = strip.near.data();
    for (const int k : strip.pending_pairs()) {
        for (const int disc : {near[k].discs.first, near[k].discs.second}) {
            auto& known = state.earliest[static_cast<std::size_t>(disc)];
            known.time = std::max(known.known_in == sweep ? known.time : 0, near[k].time);
            known.known_in = sweep;
        }
    }
}

/// The first half of a sweep.
template <Policies policies>
Changes find_pending(State<policies>& state, int index, int sweep, const WayBackOf<policies>& back) {
    Changes changes;
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    Selection pending = keep_pending(state, strip, sweep);
    const Selection asked = pairs_to_ask(state, index, sweep, changes.attempts);
    for (const int k : have_met(state, strip, asked, back)) {
        auto& pair = strip.near[static_cast<std::size_t>(k)];
        pair.time = time_of(pair.discs, state, back);
        pending.add_if((pair.time >= 0) & (pair.time < pair.last), k);
    }
    strip.pending_count = pending.count();
    know_earliest(state, strip, sweep);
    return changes;
}

/// The pending collisions that are the earliest known of both discs. They are pending no longer.
template <Policies policies> Selection take_earliest(const State<policies>& state, StripOf<policies>& strip) {
    const auto* const near = strip.near.data();
    const auto* const earliest = state.earliest.data();
    Selection taken(strip.selected);
    Selection left(strip.pending);
    for (const int k : strip.pending_pairs()) {
        const auto [first, second] = near[k].discs;
        const bool is_earliest =
            (near[k].time >= earliest[first].time) & (near[k].time >= earliest[second].time);
        taken.add_if(is_earliest, k);
        left.add_if(!is_earliest, k);
    }
    strip.pending_count = left.count();
    return taken;
}

/// The second half of a sweep. Of two collisions of a disc at one instant the second remains pending.
template <Policies policies, class SomeProbe>
Changes collide_earliest(State<policies>& state, int index, int sweep, const WayBackOf<policies>& back,
                         const ApproachToleranceOf<policies>& approaching, SomeProbe& probe) {
    Changes changes;
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    auto* const changed_in = state.changed_in.data();
    const auto* const segments_of_disc = state.segments_of_disc.data();
    const auto marker = state.active.marker();
    for (const int k : take_earliest(state, strip)) {
        auto& pair = strip.near[static_cast<std::size_t>(k)];
        const auto [first, second] = pair.discs;
        if (changed_in[first] == sweep || changed_in[second] == sweep) [[unlikely]] {
            assert(strip.pending_count < std::ssize(strip.pending));
            strip.pending[static_cast<std::size_t>(strip.pending_count++)] = k;
            continue;
        }
        const Changes made = collide_at(pair.time, state, pair.discs, back, approaching);
        tell(made, pair.time, sweep, state, pair.discs, probe);
        changes += made;
        for (const int disc : {first, second}) {
            changed_in[disc] = sweep;
            marker.mark(segments_of_disc[disc]);
        }
        pair.last = pair.time;
    }
    return changes;
}

/// The near pairs of one segment that overlap now, or are a disc and a wall.
template <Policies policies>
Selection overlapping_now(const State<policies>& state, StripOf<policies>& strip, Indices of_segment) {
    using Both = BothComponents<RealOf<policies.precision>>;
    const auto reach_squared = state.reach_squared();
    const auto* const near = strip.near.data();
    const auto* const discs = state.discs.data();
    const auto distance = [&](int k) {
        return Both::load_position(discs[near[k].discs.second]) -
               Both::load_position(discs[near[k].discs.first]);
    };
    Selection overlapping(strip.selected);
    for (int k = of_segment.first; k < of_segment.last; k += 2) {
        const auto one = distance(k);
        const auto other = distance(std::min(k + 1, of_segment.last - 1));
        const auto apart = sums(one * one, other * other) > reach_squared;
        overlapping.add_if(apart[0] == 0, k);
        overlapping.add_if((apart[1] == 0) & (k + 1 < of_segment.last), k + 1);
    }
    return overlapping;
}

/// Makes contacts of the near pairs of a strip that overlap now, and marks the segments that have some.
template <Policies policies> void make_contacts(State<policies>& state, int index) {
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    const BoxRange rows = state.grid.rows_of_strip(index, strip_height(policies.order));
    const int* near_begin = strip.near_begin.data();
    strip.contact_begin.assign(1, 0);
    for (int row = rows.first; row <= rows.last; ++row) {
        for (int segment = 0; segment < state.active.per_row(); ++segment, ++near_begin) {
            for (const int k : overlapping_now(state, strip, {near_begin[0], near_begin[1]})) {
                add_contact(state, strip.near[static_cast<std::size_t>(k)].discs, strip);
            }
            const auto end = static_cast<int>(strip.contacts.size());
            state.active.row(row)[segment] = end > strip.contact_begin.back();
            strip.contact_begin.push_back(end);
        }
    }
}

/// Makes contacts of what is still overlapping at the end of the step, a strip to an iteration.
template <Policies policies, class SomeProbe>
Tally find_left(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    parallel_for<policies.resolve_schedule>(
        tuning.threads, state.grid.strip_count(strip_height(policies.order)), tuning.resolve_chunk, probe,
        [&](int strip) { make_contacts(state, strip); });
    return {};
}

/// Takes collisions back to their time of contact, the earliest first, until none is left. The discs' places
/// change; `find` has found what is near each other.
///
/// Strips take turns as in a wavefront, two a sweep: what they write is known of, or done to, their own discs
/// and those of the next one's first row (resolve_contacts.hpp).
template <Policies policies, class SomeProbe>
Tally collide_at_contact(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    const auto back = way_back(state, tuning);
    const ApproachToleranceOf<policies> approaching(tuning.tolerance);
    const int strips = state.grid.strip_count(strip_height(policies.order));
    Wavefront wavefront(strips);
    Tuning now = tuning;
    Tally total;
    Swept last{.last_changes = few_changes};
    for (int sweep = 0; sweep < most_sweeps_at_contact && last.last_changes > 0; ++sweep) {
        const auto half_sweep = [&](const StripSweep& next) {
            const auto [strip, half] = next;
            const Changes changes = half == 0
                                        ? find_pending(state, strip, sweep, back)
                                        : collide_earliest(state, strip, sweep, back, approaching, probe);
            wavefront.ends(strip, 2 * sweep + half);
            return Tally(changes);
        };
        const auto can_begin = [&](const StripSweep& next) {
            return wavefront.can_begin(next.strip, 2 * sweep + next.sweep);
        };
        now.threads = last.last_changes < few_changes ? 1 : tuning.threads;
        probe.sweep_begin();
        last = one_sweep(sweep_in_turns<policies>(strips, 2, false, now, probe, half_sweep, can_begin));
        probe.sweep_end();
        total += last.work;
    }
    return total;
}

} // namespace carom
