#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "four_at_once.hpp"
#include "parallel_for.hpp"
#include "policies.hpp"
#include "state.hpp"

namespace carom {

/// Puts every disc's number into the list of its box, in the order of the numbers. On one thread, as the
/// published program does. Prefetch::on: the boxes of some discs are asked for before the first is needed.
template <Policies policies, class SomeProbe>
    requires(policies.storage == Storage::numbered)
void bin(State<policies>& state, const Tuning& /*tuning*/, SomeProbe& /*probe*/) {
    constexpr int at_once = policies.prefetch == Prefetch::on ? 32 : 1;
    std::array<std::vector<int>*, at_once> box_of_disc;
    for (std::vector<int>& box : state.boxes) {
        box.clear();
    }
    for (int first = 0; first < state.count(); first += at_once) {
        const int last = std::min(first + at_once, state.count());
        for (int i = first; i < last; ++i) {
            const auto& disc = state.disc(i);
            const int box = state.grid.box_of(state.grid.coordinate(disc.y), state.grid.coordinate(disc.x));
            box_of_disc[static_cast<std::size_t>(i - first)] = &state.boxes[static_cast<std::size_t>(box)];
            if constexpr (policies.prefetch == Prefetch::on) {
                __builtin_prefetch(&state.boxes[static_cast<std::size_t>(box)]);
            }
        }
        for (int i = first; i < last; ++i) {
            box_of_disc[static_cast<std::size_t>(i - first)]->push_back(i);
        }
    }
}

/// A share of `count` things for each of `parts`: the range of part `part` is [share(part), share(part + 1)).
inline int share(int part, int parts, int count) {
    return static_cast<int>(std::int64_t{count} * part / parts);
}

/// Runs `body(part)` for each of as many parts as there are threads.
template <class SomeProbe, class Body>
void for_each_part(const Tuning& tuning, SomeProbe& probe, const Body& body) {
    parallel_for<Schedule::static_>(tuning.threads, tuning.threads, 1, probe, body);
}

// The sort of the sorted storage is a stable counting sort (Knuth, The Art of Computer Programming 3, section
// 5.2) in parts, one a thread, each with boxes of its own. There is one count of each box, which only the
// part that has the box writes: of a part's discs those that lie in its own boxes, which after the first sort
// are nearly all, are counted at once, and the others are listed for the parts whose boxes they lie in. Each
// part then places the discs of its boxes: those that parts before it have listed, its own, and those that
// parts after it have listed. That is the order that they had before, however many parts there are.

/// Where each part begins when there has been no sort on so many threads: boxes and discs in even shares.
template <Policies policies> void share_evenly(State<policies>& state, int parts) {
    state.parts.resize(static_cast<std::size_t>(parts) + 1);
    for (int part = 0; part <= parts; ++part) {
        state.parts[static_cast<std::size_t>(part)].begin = {share(part, parts, state.grid.box_count()),
                                                             share(part, parts, state.count())};
    }
}

/// The part that has that box.
inline int part_of(int box, const OwnVector<PartOfSort>& parts) {
    const auto after = std::upper_bound(parts.begin(), parts.end(), box,
                                        [](int one, const PartOfSort& part) { return one < part.begin.box; });
    return static_cast<int>(after - parts.begin()) - 1;
}

/// Lists the discs of one part that lie in the boxes of others, part by part. `left` are their indices, in
/// order.
template <Policies policies> void list_leaving(State<policies>& state, int index, std::span<const int> left) {
    PartOfSort& part = state.parts[static_cast<std::size_t>(index)];
    const auto part_of_disc = [&state](int i) {
        return static_cast<std::size_t>(part_of(state.box_of_disc[static_cast<std::size_t>(i)], state.parts));
    };
    part.leaving_end.assign(state.parts.size() - 1, 0);
    for (const int i : left) {
        ++part.leaving_end[part_of_disc(i)];
    }
    std::exclusive_scan(part.leaving_end.begin(), part.leaving_end.end(), part.leaving_end.begin(),
                        part.discs.first);
    for (const int i : left) {
        state.leaving[static_cast<std::size_t>(part.leaving_end[part_of_disc(i)]++)] = i;
    }
}

/// Counts one part's discs in its own boxes and lists the others.
template <Policies policies> void count_part(State<policies>& state, int index) {
    PartOfSort& part = state.parts[static_cast<std::size_t>(index)];
    const PartOfSort& next = state.parts[static_cast<std::size_t>(index) + 1];
    part.boxes = {part.begin.box, next.begin.box};
    part.discs = {part.begin.disc, next.begin.disc};
    int* const count = state.counts();
    std::fill(count + part.boxes.first, count + part.boxes.last, 0);
    const Indices boxes = part.boxes; // a copy: its integers could alias those that are stored
    const int* const box_of_disc = state.box_of_disc.data();
    int* const left = state.spare_numbers.data() + part.discs.first; // nothing is in there yet
    int* left_end = left;
    for (const int i : part.discs) {
        if (boxes.hold(box_of_disc[i])) {
            ++count[box_of_disc[i]];
        } else {
            *left_end++ = i;
        }
    }
    list_leaving(state, index, {left, left_end});
    part.total = part.discs.count() - static_cast<int>(left_end - left);
}

/// Counts those discs in the boxes of one part that other parts have listed.
template <Policies policies> void count_arriving(State<policies>& state, int index) {
    int* const count = state.counts();
    int arriving = 0;
    for (const PartOfSort& other : state.parts_before_end()) {
        const std::span<const int> discs = other.leaving_to(index, state.leaving);
        for (const int i : discs) {
            ++count[state.box_of_disc[static_cast<std::size_t>(i)]];
        }
        arriving += static_cast<int>(discs.size());
    }
    state.parts[static_cast<std::size_t>(index)].total += arriving;
}

/// The first of `boxes` before which there are at least so many boxes and discs in all, or the end of them.
/// `begin[box]` is the place of the first disc of a box.
inline int box_after(std::int64_t boxes_and_discs, Indices boxes, const int* begin) {
    while (boxes.count() > 0) {
        const int middle = boxes.first + boxes.count() / 2;
        if (std::int64_t{middle} + begin[middle] < boxes_and_discs) {
            boxes.first = middle + 1;
        } else {
            boxes.last = middle;
        }
    }
    return boxes.first;
}

/// Of the parts that will begin in the boxes of this one, or at their end, where they do in the next sort:
/// such that each has as many boxes and discs in all. `end` is the place after the last of their discs.
template <Policies policies> void share_anew(State<policies>& state, Indices boxes, int end) {
    const int* const begin = state.counts();
    const auto parts = static_cast<std::int64_t>(state.parts.size()) - 1;
    const std::int64_t all = std::int64_t{state.grid.box_count()} + state.count();
    const auto before = [&](int box) { return std::int64_t{box} + (box < boxes.last ? begin[box] : end); };
    for (std::int64_t part = (before(boxes.first) * parts + all - 1) / all; part < parts; ++part) {
        const std::int64_t wanted = all * part / parts;
        if (wanted >= before(boxes.last)) {
            return;
        }
        const int box = box_after(wanted, boxes, begin);
        state.parts[static_cast<std::size_t>(part)].begin = {box, static_cast<int>(before(box) - box)};
    }
}

/// Puts one disc into the next place of its box.
template <Policies policies>
[[gnu::always_inline]] inline void scatter(State<policies>& state, int i, int box,
                                           typename State<policies>::Real per_side) {
    const auto from = static_cast<std::size_t>(i);
    const auto to = static_cast<std::size_t>(state.counts()[box]++);
    state.spare_discs[to] = state.discs[from];
    state.spare_numbers[to] = state.numbers[from];
    state.spare_box_of_disc[to] = box;
    if constexpr (policies.search == Search::filtered) {
        state.near_x[to] = filter_position(state.discs[from].x, per_side);
        state.near_y[to] = filter_position(state.discs[from].y, per_side);
    }
}

/// Turns the counts of one part's boxes into places, the first of them `place`, and puts its discs there.
template <Policies policies> void place_part(State<policies>& state, int index) {
    const PartOfSort& part = state.parts[static_cast<std::size_t>(index)];
    const Indices boxes = part.boxes;
    int* const count = state.counts();
    int place = part.first_place;
    for (const int box : boxes) {
        place += std::exchange(count[box], place);
    }
    share_anew(state, boxes, place);
    const auto per_side = 1 / state.side;
    for (const PartOfSort& other : state.parts_before_end()) {
        if (&other != &part) {
            for (const int i : other.leaving_to(index, state.leaving)) {
                scatter(state, i, state.box_of_disc[static_cast<std::size_t>(i)], per_side);
            }
            continue;
        }
        for (const int i : part.discs) {
            const int box = state.box_of_disc[static_cast<std::size_t>(i)];
            if (boxes.hold(box)) {
                scatter(state, i, box, per_side);
            }
        }
    }
}

/// Makes room for what the sort writes beside the discs, untouched.
template <Policies policies> void make_room(State<policies>& state, int parts) {
    if (std::ssize(state.parts) != parts + 1) {
        share_evenly(state, parts);
    }
    state.leaving.resize(parts > 1 ? state.discs.size() : 0);
    if constexpr (policies.search == Search::filtered) {
        constexpr std::size_t more = 8;
        if (state.near_x.empty()) {
            state.near_x.resize(state.discs.size() + more);
            state.near_y.resize(state.discs.size() + more);
            std::fill(state.near_x.end() - more, state.near_x.end(), 0.F);
            std::fill(state.near_y.end() - more, state.near_y.end(), 0.F);
        }
    }
}

/// Sorts the discs by their boxes; those of one box keep their order.
template <Policies policies, class SomeProbe>
    requires(policies.storage == Storage::sorted)
void bin(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    make_room(state, tuning.threads);
    for_each_part(tuning, probe, [&](int part) { count_part(state, part); });
    if (tuning.threads > 1) {
        for_each_part(tuning, probe, [&](int part) { count_arriving(state, part); });
    }
    int place = 0;
    for (PartOfSort& part : state.parts_before_end()) {
        part.first_place = std::exchange(place, place + part.total);
    }
    state.box_begin.front() = 0;
    for_each_part(tuning, probe, [&](int part) { place_part(state, part); });
    state.discs.swap(state.spare_discs);
    state.numbers.swap(state.spare_numbers);
    state.box_of_disc.swap(state.spare_box_of_disc);
}

} // namespace carom
