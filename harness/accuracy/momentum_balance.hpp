#pragma once

#include <vector>

#include "harness/verify/overlapping_pairs.hpp"
#include "harness/verify/rounding.hpp"
#include "harness/verify/walls.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// What of the change of momentum the walls explain, step by step, for unit mass.
///
/// A pair's collision keeps momentum, so the momentum along x that a connected group of overlapping discs
/// gains in a resolve comes from the vertical walls that its discs touch, and that along y from the
/// horizontal ones. What a group gains along an axis none of whose walls it touches is not explained. The
/// impulse on a wall is what the group gained, as long as it touches one wall of the axis: that of a group
/// that reaches from wall to wall is the difference of two, and cannot be told.
class MomentumBalance {
  public:
    explicit MomentumBalance(const Walls& walls) : walls_(walls) {}

    /// Takes in a step: velocities `before` and the state `after`, in which `pairs` overlap.
    void add(const std::vector<Disc>& before, const std::vector<Disc>& after,
             const std::vector<OverlappingPair>& pairs);

    /// Magnitude of the change of momentum that no wall explains, summed as a vector over all steps.
    double unexplained() const;

    /// Momentum that all four walls took up.
    double wall_impulse() const { return wall_impulse_; }

    /// Did a group that touched two opposite walls change, so that `wall_impulse` lacks something?
    bool from_wall_to_wall() const { return from_wall_to_wall_; }

  private:
    /// Along one axis.
    struct GroupAlong {
        double gained = 0;
        bool changed = false;
        bool low = false;
        bool high = false;
    };

    void add_along(const std::vector<GroupAlong>& groups, double& unexplained);

    Walls walls_;
    double unexplained_x_ = 0;
    double unexplained_y_ = 0;
    double wall_impulse_ = 0;
    bool from_wall_to_wall_ = false;
};

/// The balance of momentum of a run, told step by step whatever the time is at which its collisions happen.
class MomentumWatch {
  public:
    /// Of a run in steps of `dt` from the state `start`, in the precision of `rounding`.
    MomentumWatch(const Scene& scene, const Rounding& rounding, Impact impact, double dt,
                  std::vector<Disc> start);

    /// Takes in the state after the next step, in which `pairs` overlap.
    void step(const std::vector<Disc>& discs, const std::vector<OverlappingPair>& pairs);

    /// The same, looking for the pairs itself, where they are needed. Returns what the walls took up.
    double step(const std::vector<Disc>& discs);

    const MomentumBalance& balance() const { return balance_; }

  private:
    void balance_at_contact(const std::vector<Disc>& discs);

    Walls walls_;
    Impact impact_;
    double dt_;
    MomentumBalance balance_;
    std::vector<Disc> before_;
};

} // namespace carom
