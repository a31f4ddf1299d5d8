#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "harness/verify/at_contact.hpp"
#include "harness/verify/overlap_groups.hpp"
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
             const std::vector<OverlappingPair>& pairs) {
        OverlapGroups groups(after.size(), pairs);
        std::vector<GroupAlong> along_x(after.size());
        std::vector<GroupAlong> along_y(after.size());
        const auto take = [this](GroupAlong& group, double position, double gained) {
            group.gained += gained;
            group.changed = group.changed || gained != 0;
            group.low = group.low || walls_.touches_low(position);
            group.high = group.high || walls_.touches_high(position);
        };
        for (std::size_t i = 0; i < after.size(); ++i) {
            const auto lowest = static_cast<std::size_t>(groups.lowest(static_cast<int>(i)));
            take(along_x[lowest], after[i].x, after[i].vx - before[i].vx);
            take(along_y[lowest], after[i].y, after[i].vy - before[i].vy);
        }
        add_along(along_x, unexplained_x_);
        add_along(along_y, unexplained_y_);
    }

    /// Magnitude of the change of momentum that no wall explains, summed as a vector over all steps.
    double unexplained() const { return std::hypot(unexplained_x_, unexplained_y_); }

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

    void add_along(const std::vector<GroupAlong>& groups, double& unexplained) {
        for (const GroupAlong& group : groups) {
            if (!group.low && !group.high) {
                unexplained += group.gained;
            } else if (group.low && group.high) {
                from_wall_to_wall_ = from_wall_to_wall_ || group.changed;
            } else {
                wall_impulse_ += group.low ? group.gained : -group.gained;
            }
        }
    }

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
                  std::vector<Disc> start)
        : walls_{.side = rounding(scene.side), .radius = rounding(scene.radius), .rounding = rounding},
          impact_(impact), dt_(rounding(dt)),
          balance_(impact == Impact::at_contact ? widened(walls_) : walls_), before_(std::move(start)) {}

    /// Takes in the state after the next step, in which `pairs` overlap.
    void step(const std::vector<Disc>& discs, const std::vector<OverlappingPair>& pairs) {
        if (impact_ == Impact::at_contact) {
            balance_at_contact(discs);
        } else {
            balance_.add(before_, discs, pairs);
        }
        before_ = discs;
    }

    const MomentumBalance& balance() const { return balance_; }

  private:
    /// The walls were met where the discs flew freely, not where they are.
    void balance_at_contact(const std::vector<Disc>& discs) {
        std::vector<Disc> free = flown(before_, dt_, walls_);
        const auto pairs = colliding_pairs(free, discs, walls_);
        for (std::size_t i = 0; i < free.size(); ++i) {
            free[i].vx = discs[i].vx;
            free[i].vy = discs[i].vy;
        }
        balance_.add(before_, free, pairs);
    }

    Walls walls_;
    Impact impact_;
    double dt_;
    MomentumBalance balance_;
    std::vector<Disc> before_;
};

} // namespace carom
