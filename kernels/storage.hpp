#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "grid.hpp"
#include "parallel_for.hpp"
#include "policies.hpp"
#include "probe.hpp"
#include "scene.hpp"
#include "threads/own_lines.hpp"

namespace carom {

/// The discs and which box holds which, by `Policies::storage`.
template <Storage storage, class Real> struct DiscsOf;

/// The published layout: disc i at index i, and for each box a growable list of the numbers of its discs.
template <class Real> struct DiscsOf<Storage::numbered, Real> {
    std::vector<BasicDisc<Real>> discs;
    std::vector<std::vector<int>> boxes;
    int boxes_ahead; ///< how many boxes hold about eight discs, at most twelve: see look_ahead.hpp

    DiscsOf(const Scene& scene, const Grid& grid, int threads)
        : discs(scene.discs.size()), boxes(static_cast<std::size_t>(grid.box_count())),
          boxes_ahead(static_cast<int>(std::clamp(
              8.0 * grid.box_count() / std::max(static_cast<double>(discs.size()), 1.0), 1.0, 12.0))) {
        place(scene, threads);
    }

    /// Puts the discs where the scene has them.
    void place(const Scene& scene, int /*threads*/) {
        std::ranges::transform(scene.discs, discs.begin(), disc_cast<Real, double>);
    }

    const std::vector<int>& discs_in_box(int box) const { return boxes[static_cast<std::size_t>(box)]; }
    int number(int i) const { return i; }
};

/// The integers of [first, last), to iterate over: std::views::iota, which clang 14 cannot compile.
struct Indices {
    struct Iterator {
        int i;
        int operator*() const { return i; }
        Iterator& operator++() {
            ++i;
            return *this;
        }
        bool operator==(const Iterator& other) const { return i == other.i; }
    };

    int first;
    int last;

    Iterator begin() const { return {first}; }
    Iterator end() const { return {last}; }
    int count() const { return last - first; }
    bool hold(int i) const { return first <= i && i < last; }
};

/// One part of the sort (bin.hpp), in a cache line of its own: one thread writes it while others write
/// others.
struct alignas(cache_line) PartOfSort {
    struct Begin {
        int box;
        int disc;
    };
    Begin begin{0, 0};   ///< of the next sort: the first of its boxes and of its discs, as they lie now
    Indices boxes{0, 0}; ///< of this sort: its boxes
    Indices discs{0, 0}; ///< ditto: the indices, before it, of the discs that it looks through
    int total = 0;       ///< how many discs its boxes hold
    int first_place = 0; ///< where the first of these goes
    OwnVector<int> leaving_end; ///< of each part, the end of the discs listed for it

    /// Those of its discs that lie in the boxes of another part. `leaving` are those of all parts.
    std::span<const int> leaving_to(int part, std::span<const int> leaving) const {
        const auto to = static_cast<std::size_t>(part);
        const auto first = static_cast<std::size_t>(part == 0 ? discs.first : leaving_end[to - 1]);
        return leaving.subspan(first, static_cast<std::size_t>(leaving_end[to]) - first);
    }
};

/// Discs in the order of their boxes, row by row; in a box they keep the order that they had before. A box is
/// a range of indices, and so is a run of neighbouring boxes of one row.
template <class Real> struct DiscsOf<Storage::sorted, Real> {
    UntouchedVector<BasicDisc<Real>> discs;
    UntouchedVector<int> numbers;     ///< the number, in the scene, of the disc at each index
    UntouchedVector<int> box_of_disc; ///< written by the move, and then sorted with the discs
    UntouchedVector<int> box_begin; ///< index of the first disc of each box; one more, the count, at the end

    UntouchedVector<float> near_x; ///< Search::filtered: positions in float, and eight more that mean nothing
    UntouchedVector<float> near_y; ///< ditto

    UntouchedVector<BasicDisc<Real>> spare_discs; ///< what the sort writes into, then swapped
    UntouchedVector<int> spare_numbers;
    UntouchedVector<int> spare_box_of_disc;
    UntouchedVector<int>
        leaving; ///< of each part of the sort, in its share of the indices, the discs that it lists
    OwnVector<PartOfSort> parts; ///< of the sort; one more, which has nothing, at the end

    DiscsOf(const Scene& scene, const Grid& grid, int threads)
        : discs(scene.discs.size()), numbers(discs.size()), box_of_disc(discs.size()),
          box_begin(static_cast<std::size_t>(grid.box_count()) + 1), spare_discs(discs.size()),
          spare_numbers(discs.size()), spare_box_of_disc(discs.size()) {
        place(scene, threads);
    }

    /// Puts the discs where the scene has them, in the order of their numbers.
    void place(const Scene& scene, int threads) {
        NoProbe probe;
        parallel_for<Schedule::static_>(threads, static_cast<int>(discs.size()), 1, probe, [&](int i) {
            const auto index = static_cast<std::size_t>(i);
            discs[index] = disc_cast<Real>(scene.discs[index]);
            numbers[index] = i;
        });
    }

    /// How many discs each box holds, while they are sorted, and then where the next of them goes. When the
    /// last of them has gone there that is the begin of the next box.
    int* counts() { return box_begin.data() + 1; }

    std::span<PartOfSort> parts_before_end() { return {parts.data(), parts.size() - 1}; }

    int begin_of(int box) const { return box_begin[static_cast<std::size_t>(box)]; }
    Indices discs_in_box(int box) const { return {begin_of(box), begin_of(box + 1)}; }
    int number(int i) const { return numbers[static_cast<std::size_t>(i)]; }
};

} // namespace carom
