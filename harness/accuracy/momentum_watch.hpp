#pragma once

#include <vector>

#include "harness/accuracy/momentum_balance.hpp"
#include "harness/verify/overlapping_pairs.hpp"
#include "harness/verify/rounding.hpp"
#include "harness/verify/walls.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// The balance of momentum of a run, told step by step whatever the time is at which its collisions happen.
class MomentumWatch {
  public:
    /// Of a run in steps of `dt` from the state `start`, in the precision of `rounding`.
    MomentumWatch(const Scene& scene, const Rounding& rounding, Impact impact, double dt,
                  std::vector<Disc> start);

    /// Takes in the state after the next step, in which `pairs` overlap.
    void step(const std::vector<Disc>& discs, const std::vector<OverlappingPair>& pairs);

    /// The same, looking for the pairs itself, where they are needed.
    void step(const std::vector<Disc>& discs);

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
