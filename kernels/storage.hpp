#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <ranges>
#include <vector>

#include "grid.hpp"
#include "policies.hpp"
#include "scene.hpp"

namespace carom {

/// The discs and which box holds which, by `Policies::storage`.
template <Storage storage, class Real> struct DiscsOf;

template <class Real> std::vector<BasicDisc<Real>> discs_of(const Scene& scene) {
    std::vector<BasicDisc<Real>> discs(scene.discs.size());
    std::ranges::transform(scene.discs, discs.begin(),
                           [](const Disc& disc) { return disc_cast<Real>(disc); });
    return discs;
}

/// The published layout: disc i at index i, and for each box a growable list of the numbers of its discs.
template <class Real> struct DiscsOf<Storage::numbered, Real> {
    std::vector<BasicDisc<Real>> discs;
    std::vector<std::vector<int>> boxes;
    int boxes_ahead; ///< how many boxes hold about eight discs, at most twelve: see look_ahead.hpp

    DiscsOf(const Scene& scene, const Grid& grid)
        : discs(discs_of<Real>(scene)), boxes(static_cast<std::size_t>(grid.box_count())),
          boxes_ahead(static_cast<int>(std::clamp(
              8.0 * grid.box_count() / std::max(static_cast<double>(discs.size()), 1.0), 1.0, 12.0))) {}

    const std::vector<int>& discs_in_box(int box) const { return boxes[static_cast<std::size_t>(box)]; }
    int number(int i) const { return i; }
};

/// The integers of [first, last).
using Indices = std::ranges::iota_view<int, int>;

/// Discs in the order of their boxes, row by row; in a box they keep the order that they had before. A box is
/// a range of indices, and so is a run of neighbouring boxes of one row.
template <class Real> struct DiscsOf<Storage::sorted, Real> {
    std::vector<BasicDisc<Real>> discs;
    std::vector<int> numbers;     ///< the number, in the scene, of the disc at each index
    std::vector<int> box_of_disc; ///< written by the move, and then sorted with the discs
    std::vector<int> box_begin;   ///< index of the first disc of each box; one more, the count, at the end

    std::vector<float> near_x; ///< Search::filtered: positions in float, and four more that mean nothing
    std::vector<float> near_y; ///< ditto

    std::vector<BasicDisc<Real>> spare_discs; ///< what the sort writes into, then swapped
    std::vector<int> spare_numbers;
    std::vector<int> spare_box_of_disc;
    std::vector<std::vector<int>>
        places; ///< of each part of the sort: for each box, its discs, then their place

    DiscsOf(const Scene& scene, const Grid& grid)
        : discs(discs_of<Real>(scene)), numbers(discs.size()), box_of_disc(discs.size()),
          box_begin(static_cast<std::size_t>(grid.box_count()) + 1), spare_discs(discs.size()),
          spare_numbers(discs.size()), spare_box_of_disc(discs.size()) {
        std::iota(numbers.begin(), numbers.end(), 0);
    }

    int begin_of(int box) const { return box_begin[static_cast<std::size_t>(box)]; }
    Indices discs_in_box(int box) const { return {begin_of(box), begin_of(box + 1)}; }
    int number(int i) const { return numbers[static_cast<std::size_t>(i)]; }
};

} // namespace carom
