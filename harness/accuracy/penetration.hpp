#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "harness/verify/disc_states.hpp"
#include "harness/verify/overlapping_pairs.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// How deep discs get into each other, in units of r: 2 - |d| / r of every overlapping pair that did not
/// overlap at the start. Equal hard discs never do: all of it is error of the step.
class Penetration {
  public:
    /// `at_start` are the pairs that overlap at the start, to be left out for good.
    Penetration(const std::vector<OverlappingPair>& at_start, double radius) : radius_(radius) {
        for (const OverlappingPair& pair : at_start) {
            left_out_.insert(key(pair));
        }
    }

    void add(const std::vector<Disc>& discs, const std::vector<OverlappingPair>& pairs) {
        for (const OverlappingPair& pair : pairs) {
            if (left_out_.contains(key(pair))) {
                continue;
            }
            const Disc& one = discs[static_cast<std::size_t>(pair.first)];
            const Disc& two = discs[static_cast<std::size_t>(pair.second)];
            const double distance = distance_of(seen_from(one, two));
            const double depth = std::max(2 - distance / radius_, 0.0);
            worst_ = std::max(worst_, depth);
            sum_ += depth;
            ++count_;
        }
    }

    double worst() const { return worst_; }
    double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0; }

  private:
    static std::uint64_t key(const OverlappingPair& pair) {
        const auto low = static_cast<std::uint64_t>(std::min(pair.first, pair.second));
        return low << 32 | static_cast<std::uint64_t>(std::max(pair.first, pair.second));
    }

    double radius_;
    std::unordered_set<std::uint64_t> left_out_;
    double worst_ = 0;
    double sum_ = 0;
    std::int64_t count_ = 0;
};

} // namespace carom
