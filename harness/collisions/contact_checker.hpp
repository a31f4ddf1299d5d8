#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "harness/collisions/collision_checker.hpp"
#include "harness/collisions/contact_motion.hpp"
#include "harness/collisions/near_discs.hpp"
#include "harness/verify/checker.hpp"
#include "kernels/policies.hpp"
#include "kernels/probe.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// Goes through the collisions at contact that a variant tells, step by step, with a search and an arithmetic
/// of its own. What holds of every step:
///  - Discs fly freely to its end, to the last bit. From there each collision is followed back by the motion
///    that its discs have when it is made: at its time they were 2r apart and approaching, or a disc touched
///    a wall; it is within the way back, and before the last one of the same two.
///  - The two exchange the components of their velocities along the line of centres of that moment, and these
///    alone, which keeps their momentum and energy, and are where they have flown with them since. A wall
///    turns one component, and the path.
///  - Earliest first: neither disc surely had an earlier collision that was pending when this one was made,
///    and no disc has two in one sweep.
///  - None is left, unless the sweeps were not enough.
///  - After the last of them all discs stay where they are, to the last bit. What still overlaps is resolved
///    as at a step's end: nothing that is near is left colliding, and what is to be conserved is.
///
/// "Surely" is whatever the rounding of the variant's precision: contact_motion.hpp.
class ContactChecker final : public CollisionChecker, public CollisionLog<double> {
  public:
    ContactChecker(const Scene& scene, const Policies& policies, const Tuning& tuning);

    CollisionLog<double>& log() override { return *this; }
    void collided(const Collision<double>& collision) override;
    std::optional<std::string> violation_so_far() const override { return std::nullopt; }
    std::optional<std::string> step(const std::vector<Disc>& before, const std::vector<Disc>& after) override;

  private:
    using Found = std::optional<std::string>;

    Found collide_sweeps();
    Found violation_of(const Collision<double>& collision);
    Found wrong_pair(const Collision<double>& collision) const;
    Found wrong_exchange(const Collision<double>& collision, const Disc& d, double uncertain) const;
    Found wrong_wall(const Collision<double>& collision) const;
    Found earlier(int disc, const Collision<double>& collision) const;
    std::optional<PastCollision> surely_pending(const DiscsNearby& near) const;
    Found left_pending() const;
    Found wrong_after(const std::vector<Disc>& after) const;

    const Disc& disc(int i) const { return discs_[static_cast<std::size_t>(i)]; }

    Checker at_end_; ///< of what is resolved at the step's end
    ContactRules rules_;
    int steps_ = 0;
    std::mutex telling_;
    std::vector<Collision<double>> collisions_; ///< of this step
    std::vector<Disc> discs_;                   ///< at its end, as far as collisions have been made
    NearDiscs near_;                            ///< at the end of the free flight
    int sweeps_ = 0;                            ///< in which something collided
};

} // namespace carom
