#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "harness/verify/overlapping_pairs.hpp"

namespace carom {

/// The connected groups of overlapping discs, as disjoint sets: each disc points towards the lowest number
/// known of its group.
class OverlapGroups {
  public:
    OverlapGroups(std::size_t count, const std::vector<OverlappingPair>& pairs) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0);
        for (const OverlappingPair& pair : pairs) {
            const int first = lowest(pair.first);
            const int second = lowest(pair.second);
            parent(std::max(first, second)) = std::min(first, second);
        }
    }

    /// The lowest number of the discs in the group of disc i.
    int lowest(int i) {
        while (parent(i) != i) {
            parent(i) = parent(parent(i));
            i = parent(i);
        }
        return i;
    }

  private:
    int& parent(int i) { return parent_[static_cast<std::size_t>(i)]; }

    std::vector<int> parent_;
};

} // namespace carom
