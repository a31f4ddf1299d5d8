#include "harness/verify/overlapping_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "harness/verify/sort_and_sweep.hpp"

namespace carom {

std::vector<OverlappingPair> overlapping_pairs(const std::vector<Disc>& discs, double radius,
                                               const Rounding& rounding) {
    const double reach_squared = rounding(2 * radius * (2 * radius));
    const double around = radius * (1 + std::max(1e-9, 8 * rounding.epsilon()));
    std::vector<Extent> extents;
    std::vector<int> numbers; // of the discs with finite centres
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const auto& [x, y, vx, vy] = discs[i];
        if (std::isfinite(x) && std::isfinite(y)) {
            extents.push_back({x - around, x + around, y - around, y + around});
            numbers.push_back(static_cast<int>(i));
        }
    }
    std::vector<OverlappingPair> pairs;
    for_each_meeting(extents, [&](std::size_t first, std::size_t second) {
        const Disc& one = discs[static_cast<std::size_t>(numbers[first])];
        const Disc& two = discs[static_cast<std::size_t>(numbers[second])];
        const double dx = rounding(one.x - two.x);
        const double dy = rounding(one.y - two.y);
        if (rounding(rounding(dx * dx) + rounding(dy * dy)) <= reach_squared) {
            pairs.push_back({numbers[first], numbers[second]});
        }
    });
    return pairs;
}

} // namespace carom
