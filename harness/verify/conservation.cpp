#include "harness/verify/conservation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "harness/support/format.hpp"
#include "harness/verify/overlap_groups.hpp"

namespace carom {
namespace {

/// Sums over the discs of a group. Speeds are in units of the scene's fastest, so that no square underflows;
/// the lever of the angular momentum is the distance from the group's lowest disc.
struct GroupTotals {
    int size = 0;
    bool at_wall = false;
    double speed_sum = 0;
    double energy_before = 0;
    double energy_after = 0;
    double momentum_change_x = 0;
    double momentum_change_y = 0;
    double centre_change_x = 0;
    double centre_change_y = 0;
    double centre_slack = 0;
    double angular_scale = 0;
    double angular_change = 0;
    double angular_slack = 0;
};

double fastest(const std::vector<Disc>& discs) {
    double speed = 0;
    for (const Disc& disc : discs) {
        speed = std::max({speed, std::abs(disc.vx), std::abs(disc.vy)});
    }
    return speed > 0 ? speed : 1;
}

void add(GroupTotals& group, const Disc& free, const Disc& after, const Disc& lowest, double unit,
         double epsilon, Impact impact) {
    const double old_x = free.vx / unit;
    const double old_y = free.vy / unit;
    const double new_x = after.vx / unit;
    const double new_y = after.vy / unit;
    const double lever_x = after.x - lowest.x;
    const double lever_y = after.y - lowest.y;
    const double speed = std::hypot(old_x, old_y);
    group.size += 1;
    group.speed_sum += speed;
    group.energy_before += 0.5 * (old_x * old_x + old_y * old_y);
    group.energy_after += 0.5 * (new_x * new_x + new_y * new_y);
    group.momentum_change_x += new_x - old_x;
    group.momentum_change_y += new_y - old_y;
    const double speeds = speed + std::hypot(new_x, new_y);
    group.angular_scale += std::hypot(lever_x, lever_y) * speeds;
    group.angular_change += lever_x * (new_y - old_y) - lever_y * (new_x - old_x);
    if (after.x != free.x || after.y != free.y) {
        const double moved_x = after.x - free.x;
        const double moved_y = after.y - free.y;
        const double slack = 64 * epsilon * (std::abs(free.x) + std::abs(free.y));
        group.centre_change_x += moved_x;
        group.centre_change_y += moved_y;
        group.centre_slack += slack;
        group.angular_change += moved_x * old_y - moved_y * old_x;
        group.angular_slack += slack * speeds;
    } else if (impact == Impact::at_contact && after != free) {
        group.angular_slack += epsilon * (std::abs(free.x) + std::abs(free.y)) * speeds;
    }
}

std::optional<std::string> violation_of(const GroupTotals& group, int lowest, double tolerance) {
    const auto who = [&] {
        return format("the group of %d overlapping discs around disc %d", group.size, lowest);
    };
    if (!(std::abs(group.energy_after - group.energy_before) <= tolerance * group.energy_before)) {
        return who() + format(" changed its energy by %.17g of what it had",
                              (group.energy_after - group.energy_before) / group.energy_before);
    }
    const double momentum_change = std::hypot(group.momentum_change_x, group.momentum_change_y);
    if (!group.at_wall && !(momentum_change <= tolerance * group.speed_sum)) {
        return who() +
               format(", away from walls, changed its momentum by %.17g of the sum of its discs' momenta",
                      momentum_change / group.speed_sum);
    }
    const double centre_change = std::hypot(group.centre_change_x, group.centre_change_y);
    if (!group.at_wall && !(centre_change <= group.centre_slack)) {
        return who() +
               format(", away from walls, moved its centre of mass by %.17g / %d", centre_change, group.size);
    }
    if (!group.at_wall &&
        !(std::abs(group.angular_change) <= tolerance * group.angular_scale + group.angular_slack)) {
        return who() +
               format(", away from walls, changed its angular momentum by %.17g of the sum of its discs'",
                      group.angular_change / group.angular_scale);
    }
    return std::nullopt;
}

/// A disc that overlaps no other: nothing but a wall may have turned it.
std::optional<std::string> violation_alone(const Disc& free, const Disc& after, int i, const Walls& walls) {
    const auto kept = [](double old_velocity, double new_velocity, bool at_wall) {
        return new_velocity == old_velocity || (at_wall && new_velocity == -old_velocity);
    };
    if (kept(free.vx, after.vx, walls.touches(free.x)) && kept(free.vy, after.vy, walls.touches(free.y))) {
        return std::nullopt;
    }
    return format("disc %d overlaps no other, yet its velocity changed from (%.17g, %.17g) to (%.17g, %.17g)",
                  i, free.vx, free.vy, after.vx, after.vy);
}

} // namespace

std::optional<std::string> conservation_violation(const std::vector<Disc>& free,
                                                  const std::vector<Disc>& after,
                                                  const std::vector<OverlappingPair>& pairs,
                                                  const Walls& walls, Impact impact) {
    const double tolerance = walls.rounding.is_double() ? 1e-10 : 1e-4;
    OverlapGroups groups(after.size(), pairs);
    const double unit = fastest(free);
    std::vector<GroupTotals> totals(after.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
        const auto lowest = static_cast<std::size_t>(groups.lowest(static_cast<int>(i)));
        GroupTotals& group = totals[lowest];
        group.at_wall = group.at_wall || walls.touches(free[i].x) || walls.touches(free[i].y);
        add(group, free[i], after[i], after[lowest], unit, walls.rounding.epsilon(), impact);
    }
    for (std::size_t i = 0; i < totals.size(); ++i) {
        const int lowest = static_cast<int>(i);
        if (totals[i].size == 0) {
            continue;
        }
        auto violation = totals[i].size == 1 ? violation_alone(free[i], after[i], lowest, walls)
                                             : violation_of(totals[i], lowest, tolerance);
        if (violation) {
            return violation;
        }
    }
    return std::nullopt;
}

} // namespace carom
