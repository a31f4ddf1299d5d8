#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <limits>

#include "collide.hpp"
#include "contacts.hpp"
#include "find.hpp"
#include "four_at_once.hpp"
#include "parallel_for.hpp"
#include "policies.hpp"
#include "state.hpp"
#include "storage.hpp"
#include "tally.hpp"
#include "threads/own_lines.hpp"

namespace carom {

/// What of the state the search for candidates reads, in registers.
template <Policies policies> struct Candidates {
    using Real = RealOf<policies.precision>;

    const BasicDisc<Real>* discs;
    const float* x;
    const float* y;
    Real reach_squared;
    float filter_reach_squared;
    bool sparse;             ///< most discs overlap none: then it pays to ask first
    std::ptrdiff_t readable; ///< so many of `x` and `y`, for assertions

    /// Of centres within twice `radius`.
    Candidates(const State<policies>& state, Real radius)
        : discs(state.discs.data()), x(state.near_x.data()), y(state.near_y.data()),
          reach_squared((2 * radius) * (2 * radius)),
          filter_reach_squared(carom::filter_reach_squared(state.side, radius)),
          sparse(static_cast<Real>(state.count()) * (state.radius * state.radius) <
                 state.side * state.side / 32),
          readable(std::ssize(state.near_x)) {}

    /// Writes disc i with each disc that may overlap it, of `own` and of `next`, to `found`, which has room
    /// for all of them and twelve more; returns the end. Without a branch on the outcome or on how many they
    /// are, up to four and eight: no processor can predict those.
    [[gnu::always_inline]] OverlappingDiscs* append(int i, Indices own, Indices next,
                                                    OverlappingDiscs* found) const {
        if constexpr (policies.search == Search::exact) {
            return append_exact(i, next, append_exact(i, own, found));
        }
        if (own.count() > 4 || next.count() > 8) [[unlikely]] {
            return append_many(i, next, append_many(i, own, found));
        }
        const unsigned in_own = may_overlap(i, own.first, own.last);
        const unsigned in_next = may_overlap(i, next.first, next.last);
        const unsigned beyond = may_overlap(i, next.first + 4, next.last);
        if (!sparse || (in_own | in_next | beyond) != 0) {
            found = write(i, own.first, in_own, found);
            found = write(i, next.first, in_next, found);
            found = write(i, next.first + 4, beyond, found);
        }
        return found;
    }

  private:
    OverlappingDiscs* append_exact(int i, Indices others, OverlappingDiscs* found) const {
        for (const int j : others) {
            *found = {i, j};
            found += overlap(discs[i], discs[j], reach_squared);
        }
        return found;
    }

    OverlappingDiscs* append_many(int i, Indices others, OverlappingDiscs* found) const {
        for (int j = others.first; j < others.last; j += 4) {
            found = write(i, j, may_overlap(i, j, others.last), found);
        }
        return found;
    }

    /// Of the four discs from j on those before `end` that may overlap disc i.
    unsigned may_overlap(int i, int j, int end) const {
        assert(j + 4 <= readable);
        return carom::may_overlap(x + j, y + j, x[i], y[i], filter_reach_squared, end - j);
    }

    /// Writes disc i with those of the four discs from j on that are in the bitmask.
    static OverlappingDiscs* write(int i, int j, unsigned bitmask, OverlappingDiscs* found) {
        static_assert(sizeof(OverlappingDiscs) == 2 * sizeof(int));
        const FourInts first{i, i, i, i};
        const FourInts second = compressed_indices(j, bitmask);
        const FourInts one_and_two = __builtin_shufflevector(first, second, 0, 4, 1, 5);
        const FourInts three_and_four = __builtin_shufflevector(first, second, 2, 6, 3, 7);
        std::memcpy(found, &one_and_two, sizeof one_and_two);
        std::memcpy(found + 2, &three_and_four, sizeof three_and_four);
        return found + compress_table.count[bitmask];
    }
};

/// Adds the contact of two discs if they overlap; returns whether they do. Coincident centres have no normal:
/// such a pair never collides, and is no contact.
template <Policies policies>
[[gnu::always_inline]] inline bool add_contact(const State<policies>& state, OverlappingDiscs pair,
                                               StripOf<policies>& strip) {
    using Real = typename State<policies>::Real;
    constexpr bool surely_overlap = policies.search == Search::exact && policies.impact == Impact::step_end;
    if (pair.at_wall()) {
        constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();
        strip.contacts.push_back({pair, {nan, nan}});
        return false;
    }
    const auto& first = state.disc(pair.first);
    const auto& second = state.disc(pair.second);
    const Real dx = second.x - first.x;
    const Real dy = second.y - first.y;
    const Real distance_squared = dx * dx + dy * dy;
    if (!surely_overlap && distance_squared > state.reach_squared()) {
        return false;
    }
    if (distance_squared >= coincident_squared<Real>) {
        const Real per_distance = 1 / std::sqrt(distance_squared);
        strip.contacts.push_back({pair, {dx * per_distance, dy * per_distance}});
    }
    return true;
}

/// Turns the candidates that do overlap into contacts; returns the number of pairs.
template <Policies policies> Tally add_contacts(const State<policies>& state, StripOf<policies>& strip) {
    Tally tally;
    for (const OverlappingDiscs pair : strip.found) {
        tally.overlaps += add_contact(state, pair, strip);
    }
    return tally;
}

/// Turns the candidates into pairs that are near each other; returns how many of them overlap.
template <Policies policies>
Tally add_near_pairs(const State<policies>& state, RealOf<policies.precision> search_reach_squared,
                     StripOf<policies>& strip) {
    using Real = typename State<policies>::Real;
    constexpr Real never = std::numeric_limits<Real>::infinity();
    Tally tally;
    for (const OverlappingDiscs pair : strip.found) {
        const auto& first = state.disc(pair.first);
        const auto& second = state.disc(pair.second);
        if (policies.search == Search::exact || overlap(first, second, search_reach_squared)) {
            tally.overlaps += !pair.at_wall() && overlap(first, second, state.reach_squared());
            strip.near.push_back({pair, never, 0});
        }
    }
    return tally;
}

/// The discs after disc i of box (row, column) among which its partners are: in its own row of boxes, and in
/// the next one. In storage order the boxes of lower rows hold only discs before, and so does a disc's own
/// box up to itself, so that half the neighbourhood is enough. `box_begin` is that of the row's first box.
template <Neighbourhood neighbourhood, class Real>
[[gnu::always_inline]] inline std::array<Indices, 2>
discs_after(int i, const BasicDisc<Real>& disc, const Grid& grid, int row, int column, const int* box_begin) {
    const BoxRange near = Look<neighbourhood>::along(grid, disc.x, column);
    const Indices own{i + 1, box_begin[near.last + 1]};
    Indices next{0, 0};
    if (Look<neighbourhood>::along(grid, disc.y, row).last > row) {
        const int* const next_begin = box_begin + grid.boxes_per_side();
        next = {next_begin[near.first], next_begin[near.last + 1]};
    }
    return {own, next};
}

/// Searches one segment of a row for partners of its discs. Disc by disc, since most boxes hold one or none.
template <Policies policies>
void search_segment(State<policies>& state, const Candidates<policies>& candidates,
                    RealOf<policies.precision> radius, FoundPairs& found, int row, BoxRange columns) {
    found.clear();
    const Grid grid = state.grid; // a copy: its integers could alias those that are stored
    [[maybe_unused]] const ActiveSegments::Segment segment = state.active.segment(row, columns);
    const int first_box = grid.box_of(row, 0);
    const int* const box_begin = state.box_begin.data() + first_box;
    const int end = box_begin[columns.last + 1];
    for (int i = box_begin[columns.first]; i < end; ++i) {
        const auto disc = static_cast<std::size_t>(i);
        const int column = state.box_of_disc[disc] - first_box;
        if constexpr (policies.worklist == Worklist::active) {
            state.segments_of_disc[disc] = segment.beside(column);
        }
        if constexpr (policies.impact == Impact::at_contact) {
            state.earliest[disc] = {};
            state.changed_in[disc] = -1;
        }
        if (grid.at_wall(row, column) && overlaps_wall(state.discs[disc], state.side, radius)) [[unlikely]] {
            OverlappingDiscs* const pair = found.room(1);
            *pair = {i, i};
            found.end_at(pair + 1);
        }
        const auto [own, next] =
            discs_after<policies.neighbourhood>(i, state.discs[disc], grid, row, column, box_begin);
        found.end_at(candidates.append(i, own, next, found.room(own.count() + next.count() + 12)));
    }
}

/// What the candidates become: contacts at once or, if collisions are taken back to their time of contact
/// first, pairs that are near each other. Returns how many are known of the strip by now.
template <Policies policies>
int add_found(const State<policies>& state, const Candidates<policies>& candidates, StripOf<policies>& strip,
              Tally& tally) {
    if constexpr (policies.impact == Impact::at_contact) {
        tally += add_near_pairs(state, candidates.reach_squared, strip);
        return static_cast<int>(strip.near.size());
    } else {
        tally += add_contacts(state, strip);
        return static_cast<int>(strip.contacts.size());
    }
}

template <Policies policies>
Tally find_in_strip(State<policies>& state, int index, RealOf<policies.precision> radius) {
    constexpr int per_segment = ActiveSegments::boxes_per_segment;
    Tally tally;
    const Candidates<policies> candidates(state, radius);
    auto& strip = state.strips[static_cast<std::size_t>(index)];
    strip.contacts.clear();
    strip.near.clear();
    OwnVector<int>& segment_begin =
        policies.impact == Impact::at_contact ? strip.near_begin : strip.contact_begin;
    segment_begin.assign(1, 0);
    const BoxRange rows = state.grid.rows_of_strip(index, strip_height(policies.order));
    for (int row = rows.first; row <= rows.last; ++row) {
        for (int column = 0; column < state.grid.boxes_per_side(); column += per_segment) {
            const int last = std::min(column + per_segment, state.grid.boxes_per_side()) - 1;
            search_segment(state, candidates, radius, strip.found, row, {column, last});
            segment_begin.push_back(add_found(state, candidates, strip, tally));
        }
    }
    strip.make_room(segment_begin.back(), state.active.per_row());
    for (int row = rows.first; row <= rows.last; ++row) {
        std::fill_n(state.active.row(row), state.active.per_row(), static_cast<unsigned char>(1));
    }
    return tally;
}

/// Finds the contacts of all discs, a strip to an iteration.
///
/// Any two strips may run at the same time: of other strips' discs only positions are read, which nobody
/// writes.
template <Policies policies, class SomeProbe>
    requires(policies.overlaps == Overlaps::contacts)
Tally find(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    using Real = typename State<policies>::Real;
    const Real radius = state.search_radius(Real{1} / static_cast<Real>(tuning.substeps));
    if constexpr (policies.impact == Impact::at_contact) {
        state.earliest.resize(state.discs.size());
        state.changed_in.resize(state.discs.size());
        state.steps_flown = std::min(state.steps_flown + 1, 2);
    }
    return parallel_for<policies.find_schedule>(
        tuning.threads, state.grid.strip_count(strip_height(policies.order)), tuning.find_chunk, probe,
        [&](int strip) { return find_in_strip(state, strip, radius); });
}

} // namespace carom
