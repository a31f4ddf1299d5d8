#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <vector>

#include "grid.hpp"
#include "parallel_for.hpp"
#include "policies.hpp"
#include "probe.hpp"
#include "scene.hpp"

namespace carom {

/// Leaves the elements of a vector as the memory comes, to be written before they are read. Systems give
/// memory when it is first touched, near the processor that does: so the threads that work on a vector get
/// it side by side, each what it will use, and nothing is written in vain.
template <class T> struct Untouched : std::allocator<T> {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

    template <class Other> struct rebind { // NOLINT(readability-identifier-naming)
        using other = Untouched<Other>;
    };

    void construct(T* /*element*/) const noexcept {}
};

template <class T> using UntouchedVector = std::vector<T, Untouched<T>>;

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
};

/// What one part of the discs brings to the sort: how many each box holds, and then the place of the next of
/// them there. Of the boxes from the first to the last that hold one: after the first sort few, since discs
/// do not move far in a step.
struct PlacesOfPart {
    BoxRange boxes{.first = 0, .last = -1};
    std::vector<int> by_box;

    int& operator[](int box) { return by_box[static_cast<std::size_t>(box - boxes.first)]; }
    bool holds(int box) const { return boxes.first <= box && box <= boxes.last; }
    bool meets(BoxRange others) const { return boxes.first <= others.last && others.first <= boxes.last; }
};

/// Discs in the order of their boxes, row by row; in a box they keep the order that they had before. A box is
/// a range of indices, and so is a run of neighbouring boxes of one row.
template <class Real> struct DiscsOf<Storage::sorted, Real> {
    UntouchedVector<BasicDisc<Real>> discs;
    UntouchedVector<int> numbers;     ///< the number, in the scene, of the disc at each index
    UntouchedVector<int> box_of_disc; ///< written by the move, and then sorted with the discs
    std::vector<int> box_begin; ///< index of the first disc of each box; one more, the count, at the end

    std::vector<float> near_x; ///< Search::filtered: positions in float, and eight more that mean nothing
    std::vector<float> near_y; ///< ditto

    UntouchedVector<BasicDisc<Real>> spare_discs; ///< what the sort writes into, then swapped
    UntouchedVector<int> spare_numbers;
    UntouchedVector<int> spare_box_of_disc;
    std::vector<PlacesOfPart> places; ///< of each part of the sort

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

    int begin_of(int box) const { return box_begin[static_cast<std::size_t>(box)]; }
    Indices discs_in_box(int box) const { return {begin_of(box), begin_of(box + 1)}; }
    int number(int i) const { return numbers[static_cast<std::size_t>(i)]; }
};

} // namespace carom
