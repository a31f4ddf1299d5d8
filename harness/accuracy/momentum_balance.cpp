#include "harness/accuracy/momentum_balance.hpp"

#include <cmath>
#include <cstddef>

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

} // namespace carom
