#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

// A conservative test for overlap in float, of four discs at once. Positions are in units of the box's side
// L. Within 2 L of the origin they are rounded by at most 2^-24 2 L, and the difference of two by 2^-22 L;
// further out they are replaced by a NaN. A pair is dropped only if its distance is surely above the reach,
// and a NaN never is.

namespace carom {

/// A position as the filter sees it; `per_side` is 1 / L.
template <class Real> float filter_position(Real position, Real per_side) {
    const Real scaled = position * per_side;
    return std::abs(scaled) <= 2 ? static_cast<float>(scaled) : std::numeric_limits<float>::quiet_NaN();
}

/// The square of the reach 2r, in units of L, widened by all rounding.
inline float filter_reach_squared(double side, double radius) {
    const double reach = (2 * radius / side + 0x1p-20) * (1 + 0x1p-20);
    return static_cast<float>(reach * reach * (1 + 0x1p-20));
}

using FourFloats [[gnu::vector_size(16)]] = float;
using FourInts [[gnu::vector_size(16)]] = int;

/// For each of the first `count` discs of the four from `x` and `y` on: -1 if it may overlap the disc at (x0,
/// y0), else 0; 0 for the rest.
inline FourInts may_overlap(const float* x, const float* y, float x0, float y0, float reach_squared,
                            int count) {
    FourFloats dx;
    FourFloats dy;
    std::memcpy(&dx, x, sizeof dx);
    std::memcpy(&dy, y, sizeof dy);
    dx -= x0;
    dy -= y0;
    constexpr FourInts lanes{0, 1, 2, 3};
    return ~(dx * dx + dy * dy > reach_squared) & (lanes < count);
}

/// Is any of the four set?
inline bool any(FourInts four) {
    std::array<std::uint64_t, 2> halves;
    std::memcpy(halves.data(), &four, sizeof halves);
    return (halves[0] | halves[1]) != 0;
}

} // namespace carom
