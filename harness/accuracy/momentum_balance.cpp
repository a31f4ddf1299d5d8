#include "harness/accuracy/momentum_balance.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include "harness/verify/at_contact.hpp"
#include "harness/verify/overlap_groups.hpp"

namespace carom {

void MomentumBalance::add(const std::vector<Disc>& before, const std::vector<Disc>& after,
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

void MomentumBalance::add_along(const std::vector<GroupAlong>& groups, double& unexplained) {
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

double MomentumBalance::unexplained() const { return std::hypot(unexplained_x_, unexplained_y_); }

MomentumWatch::MomentumWatch(const Scene& scene, const Rounding& rounding, Impact impact, double dt,
                             std::vector<Disc> start)
    : walls_{.side = rounding(scene.side), .radius = rounding(scene.radius), .rounding = rounding},
      impact_(impact), dt_(rounding(dt)), balance_(impact == Impact::at_contact ? widened(walls_) : walls_),
      before_(std::move(start)) {}

void MomentumWatch::step(const std::vector<Disc>& discs, const std::vector<OverlappingPair>& pairs) {
    if (impact_ == Impact::at_contact) {
        balance_at_contact(discs);
    } else {
        balance_.add(before_, discs, pairs);
    }
    before_ = discs;
}

double MomentumWatch::step(const std::vector<Disc>& discs) {
    const double so_far = balance_.wall_impulse();
    const bool needed = impact_ != Impact::at_contact;
    step(discs,
         needed ? overlapping_pairs(discs, walls_.radius, walls_.rounding) : std::vector<OverlappingPair>());
    return balance_.wall_impulse() - so_far;
}

/// The walls were met where the discs flew freely, not where they are.
void MomentumWatch::balance_at_contact(const std::vector<Disc>& discs) {
    std::vector<Disc> free = flown(before_, dt_, walls_);
    const auto pairs = colliding_pairs(free, discs, walls_);
    for (std::size_t i = 0; i < free.size(); ++i) {
        free[i].vx = discs[i].vx;
        free[i].vy = discs[i].vy;
    }
    balance_.add(before_, free, pairs);
}

} // namespace carom
