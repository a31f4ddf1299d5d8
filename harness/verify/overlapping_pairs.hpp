#pragma once

#include <vector>

#include "harness/verify/rounding.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// Two discs that overlap, by number.
struct OverlappingPair {
    int first;
    int second;
};

/// Every pair with |d|^2 <= (2r)^2, computed as `rounding` says, each once, in no particular order. A search
/// of its own, which shares nothing with the kernel's: discs sorted by strips of the box, O(N log N). Discs
/// whose centres are not finite overlap none.
std::vector<OverlappingPair> overlapping_pairs(const std::vector<Disc>& discs, double radius,
                                               const Rounding& rounding = Rounding());

} // namespace carom
