#include "harness/verify/overlapping_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace carom {
namespace {

/// Where a disc stands among strips of the given height, each sorted by x.
struct Key {
    double strip;
    double x;
    int disc;

    bool operator<(const Key& other) const {
        return strip != other.strip ? strip < other.strip : x < other.x;
    }
};

/// The keys of all discs with finite centres. Beyond 2^40 strips from the origin one strip takes all.
std::vector<Key> sorted_keys(const std::vector<Disc>& discs, double height) {
    std::vector<Key> keys;
    keys.reserve(discs.size());
    for (std::size_t i = 0; i < discs.size(); ++i) {
        if (std::isfinite(discs[i].x) && std::isfinite(discs[i].y)) {
            const double strip = std::clamp(std::floor(discs[i].y / height), -0x1p40, 0x1p40);
            keys.push_back({strip, discs[i].x, static_cast<int>(i)});
        }
    }
    std::sort(keys.begin(), keys.end());
    return keys;
}

} // namespace

std::vector<OverlappingPair> overlapping_pairs(const std::vector<Disc>& discs, double radius,
                                               const Rounding& rounding) {
    const double reach = 2 * radius;
    const double reach_squared = rounding(reach * reach);
    const double height = reach * (1 + std::max(1e-9, 8 * rounding.epsilon()));
    const std::vector<Key> keys = sorted_keys(discs, height);
    std::vector<OverlappingPair> pairs;
    const auto pair_up = [&](const Key& key, auto candidate, double strip) {
        const Disc& one = discs[static_cast<std::size_t>(key.disc)];
        for (; candidate != keys.end() && candidate->strip == strip && candidate->x <= key.x + height;
             ++candidate) {
            const Disc& two = discs[static_cast<std::size_t>(candidate->disc)];
            const double dx = rounding(one.x - two.x);
            const double dy = rounding(one.y - two.y);
            if (rounding(rounding(dx * dx) + rounding(dy * dy)) <= reach_squared) {
                pairs.push_back({key.disc, candidate->disc});
            }
        }
    };
    for (auto key = keys.begin(); key != keys.end(); ++key) {
        pair_up(*key, key + 1, key->strip);
        const Key above{key->strip + 1, key->x - height, 0};
        pair_up(*key, std::lower_bound(keys.begin(), keys.end(), above), above.strip);
    }
    return pairs;
}

} // namespace carom
