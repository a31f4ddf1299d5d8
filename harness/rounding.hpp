#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/policies.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// The rounding of the precision that a variant computes in, applied to doubles that hold its numbers.
///
/// A sum, difference, product or quotient of two floats, computed in double and rounded to float, is what
/// float arithmetic gives: 53 bits are at least the 2 * 24 + 2 that it takes (Figueroa, ACM SIGNUM Newsletter
/// 30, 21, 1995).
class Rounding {
  public:
    /// `epsilon` is the machine epsilon of double or of float.
    explicit Rounding(double epsilon = std::numeric_limits<double>::epsilon()) : epsilon_(epsilon) {}

    double operator()(double value) const {
        return is_double() ? value : static_cast<double>(static_cast<float>(value));
    }

    double epsilon() const { return epsilon_; }
    bool is_double() const { return epsilon_ == std::numeric_limits<double>::epsilon(); }

  private:
    double epsilon_;
};

/// Can a variant's precision hold the scene, and the squares of its lengths? A float ends at 3e38 and has
/// full precision from 1e-38 on.
inline bool holds(const Policies& policies, const Scene& scene) {
    if (policies.precision == Precision::double_) {
        return true;
    }
    constexpr double most = 1e15;
    constexpr double least = 1e-15;
    const auto fits = [](double value) { return std::abs(value) <= most; };
    return fits(scene.side) && scene.radius >= least &&
           std::ranges::all_of(scene.discs, [&](const Disc& disc) {
               return fits(disc.x) && fits(disc.y) && fits(disc.vx) && fits(disc.vy);
           });
}

/// The rounding of a variant's precision.
inline Rounding rounding_of(const Policies& policies) {
    return policies.precision == Precision::float_ ? Rounding(std::numeric_limits<float>::epsilon())
                                                   : Rounding();
}

} // namespace carom
