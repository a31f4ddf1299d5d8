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
        const double distance = std::hypot(two.x - one.x, two.y - one.y);
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

/// A counting sort.
void NearDiscs::sort_by_disc(std::size_t discs) {
    begin_.assign(discs + 1, 0);
    for (const DiscsNearby& pair : pairs_) {
        ++begin_[static_cast<std::size_t>(pair.first)];
        begin_[static_cast<std::size_t>(pair.second)] += pair.at_wall() ? 0 : 1;
    }
    std::size_t end = 0;
    for (std::size_t& begin : begin_) {
        end += begin;
        begin = end;
    }
    places_.resize(end);
    for (std::size_t place = 0; place < pairs_.size(); ++place) {
        places_[--begin_[static_cast<std::size_t>(pairs_[place].first)]] = place;
        if (!pairs_[place].at_wall()) {
            places_[--begin_[static_cast<std::size_t>(pairs_[place].second)]] = place;
        }
    }
}

std::span<const std::size_t> NearDiscs::places_of(int disc) const {
    const auto i = static_cast<std::size_t>(disc);
    return {places_.data() + begin_[i], begin_[i + 1] - begin_[i]};
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
