#pragma once

#include <cstddef>
#include <vector>

#include "harness/collisions/contact_motion.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// Two discs near each other at the end of their free flight, or a disc near a wall, as both.
struct DiscsNearby {
    int first;
    int second;
    bool surely; ///< whatever the rounding
    double last; ///< how long before the step's end they last collided; infinity if they did not

    bool at_wall() const { return first == second; }
};

/// All of them in a step, and those of each disc.
class NearDiscs {
  public:
    void find(const std::vector<Disc>& free, const ContactRules& rules);

    const std::vector<DiscsNearby>& all() const { return pairs_; }

    /// Where in `all` those of a disc stand.
    const std::vector<std::size_t>& places_of(int disc) const {
        return places_[static_cast<std::size_t>(disc)];
    }

    /// That of two discs, or of one and a wall, or null.
    DiscsNearby* find_pair(int first, int second);

  private:
    void sort_by_disc(std::size_t discs);

    std::vector<DiscsNearby> pairs_;
    std::vector<std::vector<std::size_t>> places_; ///< of each disc
};

} // namespace carom
