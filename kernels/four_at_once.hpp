#pragma once

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

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

/// Numbers selected from many, in their order, in memory that belongs to somebody else. No branch depends on
/// what is selected, which no processor can predict: each candidate is written behind the last one selected,
/// where the next one overwrites it if it is not. So there must be room for one more than are selected, or
/// for four more where candidates come four at a time.
class Selection {
  public:
    explicit Selection(std::span<int> room)
        : begin_(room.data()), end_(begin_), limit_(begin_ + room.size()) {}

    /// One of some of the others, in their place: what is written is never ahead of what is still to be read.
    static Selection from(const Selection& others) {
        Selection some = others;
        some.end_ = some.begin_;
        return some;
    }

    const int* begin() const { return begin_; }
    const int* end() const { return end_; }
    int count() const { return static_cast<int>(end_ - begin_); }

    /// `selected` is 0 or 1.
    void add_if(int selected, int number) {
        assert(end_ < limit_ && (selected == 0 || selected == 1));
        *end_ = number;
        end_ += selected;
    }

    /// Those of the four numbers from `first` on whose bits are set.
    void add_four(unsigned bitmask, int first) {
        assert(limit_ - end_ >= 4);
        const FourInts numbers = compressed_indices(first, bitmask);
        std::memcpy(end_, &numbers, sizeof numbers);
        end_ += compress_table.count[bitmask];
    }

  private:
    int* begin_;
    int* end_;
    [[maybe_unused]] const int* limit_; ///< of the room, for assertions
};

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
