#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
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
/// published program does. The boxes of some discs are asked for before the first of them is needed.
template <Policies policies, class SomeProbe>
    requires(policies.storage == Storage::numbered)
void bin(State<policies>& state, const Tuning& /*tuning*/, SomeProbe& /*probe*/) {
    constexpr int at_once = 32;
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
            __builtin_prefetch(&state.boxes[static_cast<std::size_t>(box)]);
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

/// The boxes from the first to the last of those of some discs.
inline BoxRange range_of(std::span<const int> box_of_disc) {
    BoxRange range{.first = std::numeric_limits<int>::max(), .last = -1};
    for (const int box : box_of_disc) {
        range.first = std::min(range.first, box);
        range.last = std::max(range.last, box);
    }
    return box_of_disc.empty() ? BoxRange{.first = 0, .last = -1} : range;
}

/// Parts among which so few boxes are left out that to look for them takes longer.
inline constexpr int few_parts = 2;

/// Of one part's discs, how many each box holds.
template <Policies policies> void count_part(State<policies>& state, int part, int parts) {
    PlacesOfPart& places = state.places[static_cast<std::size_t>(part)];
    const auto first = static_cast<std::size_t>(share(part, parts, state.count()));
    const auto last = static_cast<std::size_t>(share(part + 1, parts, state.count()));
    const std::span<const int> box_of_disc(state.box_of_disc.data() + first, last - first);
    places.boxes =
        parts > few_parts ? range_of(box_of_disc) : BoxRange{.first = 0, .last = state.grid.box_count() - 1};
    places.by_box.assign(static_cast<std::size_t>(places.boxes.count()), 0);
    for (const int box : box_of_disc) {
        ++places[box];
    }
}

/// The boxes of one part of them.
template <Policies policies> BoxRange boxes_of_part(const State<policies>& state, int part, int parts) {
    const int boxes = state.grid.box_count();
    return {.first = share(part, parts, boxes), .last = share(part + 1, parts, boxes) - 1};
}

/// The parts of the discs from the first to the last that may have one in `boxes`.
inline std::span<PlacesOfPart> parts_that_meet(std::vector<PlacesOfPart>& places, BoxRange boxes) {
    const auto meets = [&](const PlacesOfPart& part) { return part.meets(boxes); };
    const auto first = std::find_if(places.begin(), places.end(), meets);
    const auto last = std::find_if(places.rbegin(), std::make_reverse_iterator(first), meets).base();
    return {first, last};
}

/// How many discs the boxes of one part hold.
template <Policies policies> int total_of_part(State<policies>& state, int part, int parts) {
    const BoxRange boxes = boxes_of_part(state, part, parts);
    int total = 0;
    for (PlacesOfPart& places : parts_that_meet(state.places, boxes)) {
        const int last = std::min(boxes.last, places.boxes.last);
        for (int box = std::max(boxes.first, places.boxes.first); box <= last; ++box) {
            total += places[box];
        }
    }
    return total;
}

/// Turns the counts of one part of the boxes into places, the first of them `place`: those of a box's discs
/// follow one another in the order of the parts of the discs, and boxes follow boxes.
template <Policies policies> void place_part(State<policies>& state, int part, int parts, int place) {
    const BoxRange boxes = boxes_of_part(state, part, parts);
    const std::span<PlacesOfPart> near = parts_that_meet(state.places, boxes);
    for (int box = boxes.first; box <= boxes.last; ++box) {
        state.box_begin[static_cast<std::size_t>(box)] = place;
        for (PlacesOfPart& places : near) {
            if (places.holds(box)) {
                place += std::exchange(places[box], place);
            }
        }
    }
}

template <Policies policies> void scatter_part(State<policies>& state, int part, int parts) {
    PlacesOfPart& places = state.places[static_cast<std::size_t>(part)];
    [[maybe_unused]] const auto per_side = 1 / state.side;
    for (int i = share(part, parts, state.count()); i < share(part + 1, parts, state.count()); ++i) {
        const auto from = static_cast<std::size_t>(i);
        const int box = state.box_of_disc[from];
        const auto to = static_cast<std::size_t>(places[box]++);
        state.spare_discs[to] = state.discs[from];
        state.spare_numbers[to] = state.numbers[from];
        state.spare_box_of_disc[to] = box;
        if constexpr (policies.search == Search::filtered) {
            state.near_x[to] = filter_position(state.discs[from].x, per_side);
            state.near_y[to] = filter_position(state.discs[from].y, per_side);
        }
    }
}

/// Sorts the discs by their boxes: a stable counting sort (Knuth, The Art of Computer Programming 3, section
/// 5.2), so that the order does not depend on the number of parts.
template <Policies policies, class SomeProbe>
    requires(policies.storage == Storage::sorted)
void bin(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    const int parts = tuning.threads;
    if constexpr (policies.search == Search::filtered) {
        state.near_x.resize(state.discs.size() + 8);
        state.near_y.resize(state.discs.size() + 8);
    }
    state.places.resize(static_cast<std::size_t>(parts));
    std::vector<int> begin(static_cast<std::size_t>(parts));
    for_each_part(tuning, probe, [&](int part) { count_part(state, part, parts); });
    for_each_part(tuning, probe, [&](int part) {
        begin[static_cast<std::size_t>(part)] = total_of_part(state, part, parts);
    });
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), 0);
    for_each_part(tuning, probe,
                  [&](int part) { place_part(state, part, parts, begin[static_cast<std::size_t>(part)]); });
    state.box_begin.back() = state.count();
    for_each_part(tuning, probe, [&](int part) { scatter_part(state, part, parts); });
    state.discs.swap(state.spare_discs);
    state.numbers.swap(state.spare_numbers);
    state.box_of_disc.swap(state.spare_box_of_disc);
}

} // namespace carom
