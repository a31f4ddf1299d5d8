#include "harness/verify/at_contact.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "harness/support/format.hpp"
#include "harness/verify/conservation.hpp"
#include "harness/verify/disc_states.hpp"
#include "harness/verify/overlapping_pairs.hpp"

namespace carom {
namespace {

/// The step as the checks of this file see it.
struct Step {
    const std::vector<Disc>& before;
    const std::vector<Disc>& free;
    const std::vector<Disc>& after;
    double dt;
    const Walls& walls;
    std::vector<OverlappingPair> near; ///< at the end of the free flight
    std::vector<int> neighbours;       ///< of each disc, how many are near it then

    bool touched(int i) const { return after[index(i)] != free[index(i)]; }

    bool near_wall(int i) const {
        const Walls wide = widened(walls);
        return wide.touches(free[index(i)].x) || wide.touches(free[index(i)].y);
    }

    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
};

/// How far apart, in position and in velocity, two results of one collision may be: some roundings of where
/// the discs are, as the collision turns them.
struct Allowed {
    double position;
    double velocity;

    Allowed(const Disc& disc, const Step& step) {
        const double speed = std::hypot(disc.vx, disc.vy);
        const double extent =
            step.walls.side + std::abs(disc.x) + std::abs(disc.y) + speed * step.dt + step.walls.radius;
        const double roundings = 256 * step.walls.rounding.epsilon();
        position = roundings * extent;
        velocity = roundings * speed * (1 + extent / step.walls.radius);
    }
};

bool agree(const Disc& one, const Disc& two, const Allowed& allowed) {
    return std::hypot(one.x - two.x, one.y - two.y) <= allowed.position &&
           std::hypot(one.vx - two.vx, one.vy - two.vy) <= allowed.velocity;
}

/// Two discs that are apart, followed forward.
class TwoBodies {
  public:
    TwoBodies(const Disc& its_one, const Disc& its_two, double radius)
        : one(its_one), two(its_two), reach_(2 * radius), d_(seen_from(one, two)), closing_(-parting_of(d_)),
          gap_((distance_of(d_) - reach_) * (distance_of(d_) + reach_)),
          discriminant_(closing_ * closing_ - speed_squared() * gap_) {}

    /// Flies on for `dt`, through the contact if there is one before the time `latest`.
    void fly(double dt, double latest) {
        const bool meet = closing_ > 0 && discriminant_ >= 0;
        const double contact = meet ? gap_ / (closing_ + std::sqrt(discriminant_)) : dt;
        fly_freely(meet && contact <= latest ? contact : dt);
        if (meet && contact <= latest) {
            const double nx = (two.x - one.x) / reach_;
            const double ny = (two.y - one.y) / reach_;
            const double exchanged = d_.vx * nx + d_.vy * ny;
            one.vx += exchanged * nx;
            one.vy += exchanged * ny;
            two.vx -= exchanged * nx;
            two.vy -= exchanged * ny;
            fly_freely(dt - contact);
        }
    }

    /// How wrong the speed of approach at contact may be if positions are uncertain by `position`: of a
    /// grazing pair, whose discriminant is all rounding, by its root.
    double uncertain_speed(double position) const {
        const double uncertain = 2 * reach_ * position * speed_squared();
        const double root = std::sqrt(std::max(discriminant_, 0.0)) + std::sqrt(uncertain);
        return root > 0 ? uncertain / root / reach_ : 0;
    }

    /// How wrong the time of contact may be if positions are uncertain by `position`; infinite of a grazing
    /// pair.
    double uncertain_time(double position) const {
        return position * reach_ / std::sqrt(std::max(discriminant_, 0.0));
    }

    Disc one;
    Disc two;

  private:
    double speed_squared() const { return d_.vx * d_.vx + d_.vy * d_.vy; }

    void fly_freely(double time) {
        for (Disc* disc : {&one, &two}) {
            disc->x += disc->vx * time;
            disc->y += disc->vy * time;
        }
    }

    double reach_;
    Disc d_; ///< the second seen from the first, at the start
    double closing_;
    double gap_;
    double discriminant_;
};

/// How far apart two discs may seem to be at the end of their free flights, and are not: each coordinate has
/// been rounded twice, and so has their distance.
double rounded_by(const Step& step, const Disc& one, const Disc& two) {
    const double largest = std::max({std::abs(one.x), std::abs(one.y), std::abs(two.x), std::abs(two.y)});
    return 8 * step.walls.rounding.epsilon() * (largest + 2 * step.walls.radius);
}

/// A pair that is apart before the step, overlaps after its free flight or collided, and has nothing else
/// near it.
std::optional<std::string> pair_violation(const Step& step, const OverlappingPair& pair) {
    const auto first = Step::index(pair.first);
    const auto second = Step::index(pair.second);
    if (step.neighbours[first] > 1 || step.neighbours[second] > 1 || step.near_wall(pair.first) ||
        step.near_wall(pair.second)) {
        return std::nullopt;
    }
    const auto distance = [&](const std::vector<Disc>& discs) {
        return distance_of(seen_from(discs[first], discs[second]));
    };
    const double reach = 2 * step.walls.radius;
    const double slack = 256 * step.walls.rounding.epsilon() * (step.walls.side + reach);
    const bool were_apart = distance(step.before) > reach + slack;
    const bool overlap = distance(step.free) < reach - slack;
    if (!were_apart || !(overlap || step.touched(pair.first) || step.touched(pair.second))) {
        return std::nullopt;
    }
    TwoBodies bodies(step.before[first], step.before[second], step.walls.radius);
    Allowed allowed(step.before[first], step);
    const Allowed other(step.before[second], step);
    allowed.position = std::max(allowed.position, other.position);
    allowed.velocity = std::max(allowed.velocity, other.velocity) + bodies.uncertain_speed(allowed.position);
    allowed.position += bodies.uncertain_speed(allowed.position) * step.dt;
    const double uncertain = bodies.uncertain_time(rounded_by(step, step.free[first], step.free[second]));
    TwoBodies later = bodies; // met by the latest that rounding may still take for the end of the step
    later.fly(step.dt, step.dt + uncertain);
    bodies.fly(step.dt, step.dt - uncertain);
    for (const TwoBodies& end : {bodies, later}) {
        if (agree(step.after[first], end.one, allowed) && agree(step.after[second], end.two, allowed)) {
            return std::nullopt;
        }
    }
    return format("discs %d and %d, which met with nothing else near, are at %s and %s instead of at %s and "
                  "%s",
                  pair.first, pair.second, state_text(step.after[first]).c_str(),
                  state_text(step.after[second]).c_str(), state_text(bodies.one).c_str(),
                  state_text(bodies.two).c_str());
}

/// Does a disc fly so far in a step that it meets walls many times?
bool flies_through_box(const Step& step, const Disc& disc) {
    return !(2 * std::max(std::abs(disc.vx), std::abs(disc.vy)) * step.dt <
             step.walls.side - 2 * step.walls.radius);
}

/// Along one axis: is this where a disc ends that met nothing but, maybe, a wall? One that was in the box
/// before, and does not fly through half of it in a step, has flown back since. One that was not may have met
/// both walls in turn, or been turned at the end: it keeps its speed.
bool ends_at_wall(const Step& step, double before, const Disc& free, double Disc::* position,
                  double Disc::* velocity, const Disc& after, const Allowed& allowed) {
    const double low = step.walls.radius;
    const double high = step.walls.side - step.walls.radius;
    const double speed = std::abs(free.*velocity);
    if (!(before > low + allowed.position && before < high - allowed.position) ||
        flies_through_box(step, free)) {
        return std::abs(after.*velocity) == speed;
    }
    const bool into_low = step.walls.touches_low(free.*position) && free.*velocity < 0;
    const bool into_high = step.walls.touches_high(free.*position) && free.*velocity > 0;
    if (!into_low && !into_high) {
        return after.*position == free.*position && after.*velocity == free.*velocity;
    }
    const double reflected = 2 * (into_low ? low : high) - free.*position;
    return after.*velocity == -(free.*velocity) && std::abs(after.*position - reflected) <= allowed.position;
}

/// A disc that nothing near it touched but, maybe, a wall.
std::optional<std::string> alone_violation(const Step& step, int i) {
    const Disc& before = step.before[Step::index(i)];
    const Disc& free = step.free[Step::index(i)];
    const Disc& after = step.after[Step::index(i)];
    const Allowed allowed(before, step);
    if (ends_at_wall(step, before.x, free, &Disc::x, &Disc::vx, after, allowed) &&
        ends_at_wall(step, before.y, free, &Disc::y, &Disc::vy, after, allowed)) {
        return std::nullopt;
    }
    return format("disc %d, which met no other, flew to %s and is at %s", i, state_text(free).c_str(),
                  state_text(after).c_str());
}

std::vector<OverlappingPair> near_pairs(const std::vector<Disc>& discs, const Walls& walls) {
    const double widest = widest_look * walls.radius * (1 + 8 * walls.rounding.epsilon());
    return overlapping_pairs(discs, widest, walls.rounding);
}

Step step_of(const std::vector<Disc>& before, const std::vector<Disc>& free, const std::vector<Disc>& after,
             double dt, const Walls& walls) {
    Step step{before, free, after, dt, walls, near_pairs(free, walls), std::vector<int>(free.size())};
    for (const OverlappingPair& pair : step.near) {
        ++step.neighbours[Step::index(pair.first)];
        ++step.neighbours[Step::index(pair.second)];
    }
    return step;
}

} // namespace

std::vector<Disc> flown(const std::vector<Disc>& before, double dt, const Walls& walls) {
    std::vector<Disc> free = before;
    for (Disc& disc : free) {
        disc.x = walls.rounding(disc.x + walls.rounding(disc.vx * dt));
        disc.y = walls.rounding(disc.y + walls.rounding(disc.vy * dt));
    }
    return free;
}

Walls widened(const Walls& walls) {
    return {.side = walls.side, .radius = widest_look * walls.radius, .rounding = walls.rounding};
}

std::vector<OverlappingPair> colliding_pairs(const std::vector<Disc>& free, const std::vector<Disc>& after,
                                             const Walls& walls) {
    std::vector<OverlappingPair> pairs = near_pairs(free, walls);
    std::erase_if(pairs, [&](const OverlappingPair& pair) {
        const auto first = Step::index(pair.first);
        const auto second = Step::index(pair.second);
        const bool both_touched = after[first] != free[first] && after[second] != free[second];
        return !both_touched &&
               overlapping_pairs({free[first], free[second]}, walls.radius, walls.rounding).empty();
    });
    return pairs;
}

std::optional<std::string> at_contact_violation(const std::vector<Disc>& before,
                                                const std::vector<Disc>& free, const std::vector<Disc>& after,
                                                double dt, const Walls& walls) {
    Step step = step_of(before, free, after, dt, walls);
    for (const OverlappingPair& pair : step.near) {
        if (auto violation = pair_violation(step, pair)) {
            return violation;
        }
    }
    step.near = colliding_pairs(free, after, walls);
    std::vector<bool> alone(free.size(), true);
    for (const OverlappingPair& pair : step.near) {
        alone[Step::index(pair.first)] = false;
        alone[Step::index(pair.second)] = false;
    }
    for (int i = 0; i < static_cast<int>(free.size()); ++i) {
        if (alone[Step::index(i)]) {
            if (auto violation = alone_violation(step, i)) {
                return violation;
            }
        }
    }
    return conservation_violation(free, after, step.near, widened(walls), Impact::at_contact);
}

} // namespace carom
