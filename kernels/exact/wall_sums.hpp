#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace carom {

/// What the walls have done to the discs of the exact simulation, for unit mass. Summed disc by disc, so that
/// the sums do not depend on the order in which different discs meet walls.
template <class Real> class WallSums {
  public:
    /// Of so many discs that have met no wall yet.
    void clear(std::size_t discs) { of_disc_.assign(discs, {}); }

    /// A wall has turned a disc's velocity along one axis (0: x, 1: y), which is now `velocity`.
    void add(int disc, std::size_t axis, Real velocity) {
        OfDisc& one = of_disc_[static_cast<std::size_t>(disc)];
        one.impulse += 2 * std::abs(velocity);
        one.momentum[axis] += 2 * velocity;
    }

    /// The sum of 2 |v| over all wall collisions.
    Real impulse() const {
        Real sum = 0;
        for (const OfDisc& one : of_disc_) {
            sum += one.impulse;
        }
        return sum;
    }

    /// What the walls have changed of the momentum of all discs along x and y.
    std::array<Real, 2> momentum() const {
        std::array<Real, 2> sum{};
        for (const OfDisc& one : of_disc_) {
            sum[0] += one.momentum[0];
            sum[1] += one.momentum[1];
        }
        return sum;
    }

  private:
    struct OfDisc {
        Real impulse = 0;
        std::array<Real, 2> momentum{};
    };

    std::vector<OfDisc> of_disc_;
};

} // namespace carom
