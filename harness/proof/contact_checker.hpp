#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "harness/proof/collision_checker.hpp"
#include "harness/proof/contact_motion.hpp"
#include "harness/verify/checker.hpp"
#include "harness/verify/overlapping_pairs.hpp"
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

    /// Two discs near each other, or a disc near a wall, as both.
    struct Near {
        int first;
        int second;
        bool surely; ///< whatever the rounding
        double last; ///< how long before the step's end they last collided; infinity if they did not
    };

    void find_near(const std::vector<Disc>& free);
    Near* near_of(int first, int second);
    Found collide_sweeps();
    Found violation_of(const Collision<double>& collision);
    Found wrong_pair(const Collision<double>& collision) const;
    Found wrong_exchange(const Collision<double>& collision, const Disc& d, double uncertain) const;
    Found wrong_wall(const Collision<double>& collision) const;
    Found earlier(int disc, const Collision<double>& collision) const;
    std::optional<PastCollision> surely_pending(const Near& near) const;
    std::optional<PastCollision> surely_in_wall(const Disc& disc) const;
    Found left_pending() const;
    Found wrong_after(const std::vector<Disc>& after) const;

    const Disc& disc(int i) const { return discs_[static_cast<std::size_t>(i)]; }

    Checker at_end_; ///< of what is resolved at the step's end
    ContactRules rules_;
    int steps_ = 0;
    std::mutex telling_;
    std::vector<Collision<double>> collisions_; ///< of this step
    std::vector<Disc> discs_;                   ///< at its end, as far as collisions have been made
    std::vector<Near> near_;
    std::vector<std::size_t> first_of_disc_; ///< of each disc its first entry in `near_of_disc_`; one more
    std::vector<std::size_t> near_of_disc_;  ///< places in `near_`
    int sweeps_ = 0;                         ///< in which something collided
};

} // namespace carom
