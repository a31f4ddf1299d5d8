#include "harness/collisions/near_discs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/verify/overlapping_pairs.hpp"

namespace carom {

void NearDiscs::find(const std::vector<Disc>& free, const ContactRules& rules) {
    constexpr double never = std::numeric_limits<double>::infinity();
    const double roundings = 32 * rules.epsilon();
    pairs_.clear();
    for (const OverlappingPair& pair : overlapping_pairs(free, rules.near * (1 + roundings))) {
        const Disc& one = free[static_cast<std::size_t>(pair.first)];
        const Disc& two = free[static_cast<std::size_t>(pair.second)];
        const double distance = distance_of(seen_from(one, two));
        pairs_.push_back({pair.first, pair.second, distance < 2 * rules.near * (1 - roundings), never});
    }
    const double slack = roundings * (rules.near + rules.walls.side);
    for (int i = 0; i < static_cast<int>(free.size()); ++i) {
        const Disc& disc = free[static_cast<std::size_t>(i)];
        const double to_wall =
            std::min(std::min(disc.x, disc.y), rules.walls.side - std::max(disc.x, disc.y));
        if (to_wall <= rules.near + slack) {
            pairs_.push_back({i, i, to_wall < rules.near - slack, never});
        }
    }
    sort_by_disc(free.size());
}

void NearDiscs::sort_by_disc(std::size_t discs) {
    places_.resize(discs);
    for (auto& places : places_) {
        places.clear();
    }
    for (std::size_t place = pairs_.size(); place-- > 0;) {
        places_[static_cast<std::size_t>(pairs_[place].first)].push_back(place);
        if (!pairs_[place].at_wall()) {
            places_[static_cast<std::size_t>(pairs_[place].second)].push_back(place);
        }
    }
}

DiscsNearby* NearDiscs::find_pair(int first, int second) {
    for (const std::size_t place : places_of(first)) {
        DiscsNearby& pair = pairs_[place];
        if ((pair.first == first && pair.second == second) ||
            (pair.first == second && pair.second == first)) {
            return &pair;
        }
    }
    return nullptr;
}

} // namespace carom
