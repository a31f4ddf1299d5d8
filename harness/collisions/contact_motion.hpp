#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "harness/verify/disc_states.hpp"
#include "harness/verify/walls.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// What a step with Impact::at_contact is made of.
struct ContactRules {
    Walls walls;
    double dt;
    double
        way_back; ///< how far back discs that move into each other are followed: this step and the one before
    double near;  ///< discs within twice this at the end of their free flight are looked at
    Tolerance tolerance;

    double epsilon() const { return walls.rounding.epsilon(); }
};

/// When a collision was, before the end of the step, and how far rounding may put that time.
struct PastCollision {
    double time;
    double uncertain;
};

/// The motion of the second of two discs as the first one sees it, back from the end of a step.
///
/// Places and velocities are known to the last bit, so that the way d - v t is wrong by no more than some
/// roundings of |d| + |v t|, and its square, from which the time of contact is found, by as many of the
/// square of that and 2r: `uncertain`.
class PairBackwards {
  public:
    PairBackwards(const ContactRules& rules, const Disc& one, const Disc& two)
        : rules_(rules), d_(seen_from(one, two)), speeds_(std::hypot(speed_of(one), speed_of(two))),
          way_back_(parting_of(d_) < 0 ? rules.way_back : rules.dt) {
        const double farthest = distance_of(d_) + speed_of(d_) * way_back_ + reach();
        uncertain_ = 32 * rules.epsilon() * farthest * farthest;
    }

    double reach() const { return 2 * rules_.walls.radius; }
    double way_back() const { return way_back_; }

    /// Where the second disc was, seen from the first.
    Disc at(double time) const { return {d_.x - d_.vx * time, d_.y - d_.vy * time, d_.vx, d_.vy}; }

    /// How wrong the square of a distance may be.
    double uncertain() const { return uncertain_; }

    /// The collision that these two surely had, if they have flown as they do now: whatever the rounding,
    /// they were apart when the way back begins, have met since, and approached by more than what is let be.
    std::optional<PastCollision> surely_met() const {
        const double a = d_.vx * d_.vx + d_.vy * d_.vy;
        const double b = parting_of(d_);
        const double c = d_.x * d_.x + d_.y * d_.y - reach() * reach();
        const double discriminant = b * b - a * c;
        const double closing = std::sqrt(std::max(discriminant, 0.0));
        const bool were_apart = c - way_back_ * (2 * b - a * way_back_) > uncertain_;
        const double uncertain_b = 32 * rules_.epsilon() * std::sqrt(a) * (distance_of(d_) + reach());
        const bool parted = b > uncertain_b && b < a * way_back_ - uncertain_b;
        const bool in_contact = c < -uncertain_;
        if (!were_apart || !(in_contact || parted) || discriminant <= 4 * a * uncertain_ ||
            closing <= let_be()) {
            return std::nullopt;
        }
        const double time = b < 0 ? -c / (closing - b) : (b + closing) / a;
        const PastCollision met{time, uncertain_ / closing + 32 * rules_.epsilon() * time};
        const bool within = time > met.uncertain && time < way_back_ - met.uncertain;
        return within ? std::optional(met) : std::nullopt;
    }

  private:
    /// An approach, times 2r, that is not resolved; with as much again, since both round.
    double let_be() const {
        const double relative = 2 * 64 * rules_.epsilon() * reach() * speeds_;
        return rules_.tolerance == Tolerance::published ? std::max(relative, 2e-7) : relative;
    }

    const ContactRules& rules_;
    Disc d_;
    double speeds_;
    double way_back_;
    double uncertain_;
};

/// The time since which a disc has been in the wall that it moves into along one axis, as the variant's
/// precision has it; below 0 if it is in none, or has been for longer than the way back.
inline double time_in_wall(const ContactRules& rules, double position, double velocity) {
    const Walls& walls = rules.walls;
    const bool inside =
        velocity < 0 ? walls.touches_low(position) : velocity > 0 && walls.touches_high(position);
    const double depth = velocity < 0 ? walls.rounding(walls.radius - position)
                                      : walls.rounding(walls.rounding(position + walls.radius) - walls.side);
    const double time = inside ? walls.rounding(depth / std::abs(velocity)) : -1;
    return time <= rules.way_back ? time : -1;
}

} // namespace carom
