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

    double operator()(double value) const { return is_double() ? value : to_float(value); }

    double epsilon() const { return epsilon_; }
    bool is_double() const { return epsilon_ == std::numeric_limits<double>::epsilon(); }

  private:
    /// Not inlined: of two roundings side by side GCC 12 at -O2 drops both conversions (its vectoriser of
    /// straight-line code merges the branches).
    [[gnu::noinline]] static double to_float(double value) {
        return static_cast<double>(static_cast<float>(value));
    }

    double epsilon_;
};

/// Can a variant's precision hold the scene, and what is computed of it: the squares of its lengths, and of
/// its lengths times its speeds? A float ends at 3e38 and has full precision from 1e-38 on. What collisions
/// may add to the fastest speed is left room for.
inline bool holds(const Policies& policies, const Scene& scene) {
    if (policies.precision == Precision::double_) {
        return true;
    }
    constexpr double most = 1e15;
    const auto fits = [](double value) { return std::abs(value) <= most; };
    double speed = 0;
    for (const Disc& disc : scene.discs) {
        if (!fits(disc.x) || !fits(disc.y)) {
            return false;
        }
        speed = std::max({speed, std::abs(disc.vx), std::abs(disc.vy)});
    }
    const double swept = scene.radius * speed;
    return fits(scene.side) && scene.radius >= 1 / most && fits(speed) &&
           (speed == 0 || (swept >= 1e-15 && swept <= 1e17));
}

/// The rounding of a variant's precision.
inline Rounding rounding_of(const Policies& policies) {
    return policies.precision == Precision::float_ ? Rounding(std::numeric_limits<float>::epsilon())
                                                   : Rounding();
}

} // namespace carom
