#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

// Four discs or contacts at a time, or two pairs, in registers, by GNU's vectors and one instruction of its
// own. A mask is -1 where something is true and 0 elsewhere; a bitmask has a bit for each of the four, that
// of the first one the lowest.

namespace carom {

using FourFloats [[gnu::vector_size(16)]] = float;
using FourInts [[gnu::vector_size(16)]] = int;

/// A mask as a bitmask.
inline unsigned to_bitmask_portably(FourInts mask) {
    const FourInts bits = mask & FourInts{1, 2, 4, 8};
    std::array<std::uint64_t, 2> halves;
    std::memcpy(halves.data(), &bits, sizeof halves);
    const std::uint64_t both = halves[0] | halves[1];
    return static_cast<unsigned>(both | both >> 32) & 15U;
}

/// The same, by the one instruction for it where there is one.
inline unsigned to_bitmask(FourInts mask) {
#ifdef __SSE__
    FourFloats signs;
    std::memcpy(&signs, &mask, sizeof signs);
    return static_cast<unsigned>(__builtin_ia32_movmskps(signs));
#else
    return to_bitmask_portably(mask);
#endif
}

/// Of each bitmask the numbers of its bits, in order, and how many it has: what a compress instruction does.
struct CompressTable {
    alignas(16) std::array<std::array<int, 4>, 16> indices{};
    std::array<int, 16> count{};

    constexpr CompressTable() {
        for (unsigned bitmask = 0; bitmask < 16; ++bitmask) {
            for (int bit = 0; bit < 4; ++bit) {
                if ((bitmask >> bit & 1U) != 0) {
                    indices[bitmask][static_cast<std::size_t>(count[bitmask]++)] = bit;
                }
            }
        }
    }
};

inline constexpr CompressTable compress_table;

/// The numbers from `first` on whose bits are set, in order; what follows the last of them means nothing.
inline FourInts compressed_indices(int first, unsigned bitmask) {
    FourInts indices;
    std::memcpy(&indices, compress_table.indices[bitmask].data(), sizeof indices);
    return indices + first;
}

/// Of four, the first `count`: -1; the rest: 0.
inline FourInts mask_of_first(int count) { return FourInts{0, 1, 2, 3} < count; }

/// The sum of the two components of each of two vectors.
template <class Both> [[gnu::always_inline]] inline Both sums(Both one, Both other) {
    return __builtin_shufflevector(one, other, 0, 2) + __builtin_shufflevector(one, other, 1, 3);
}

/// Of each of four vectors, whether the sum of its two components is below 0, or a NaN; as a mask.
template <class Both> FourInts sums_below_zero(Both first, Both second, Both third, Both fourth) {
    const auto before = ~(sums(first, second) >= 0);
    const auto after = ~(sums(third, fourth) >= 0);
    if constexpr (sizeof before == sizeof(FourInts)) {
        return __builtin_shufflevector(FourInts(before), FourInts(after), 0, 2, 4, 6);
    } else {
        return __builtin_shufflevector(before, after, 0, 1, 2, 3);
    }
}

// A conservative test for overlap in float. Positions are in units of the box's side L. Within 2 L of the
// origin they are rounded by at most 2^-24 2 L, and the difference of two by 2^-22 L; further out they are
// replaced by a NaN. A pair is dropped only if its distance is surely above the reach, and a NaN never is.

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

/// Of the first `count` discs of the four from `x` and `y` on those that may overlap the disc at (x0, y0), as
/// a bitmask.
inline unsigned may_overlap(const float* x, const float* y, float x0, float y0, float reach_squared,
                            int count) {
    FourFloats dx;
    FourFloats dy;
    std::memcpy(&dx, x, sizeof dx);
    std::memcpy(&dy, y, sizeof dy);
    dx -= x0;
    dy -= y0;
    return to_bitmask(~(dx * dx + dy * dy > reach_squared) & mask_of_first(count));
}

} // namespace carom
