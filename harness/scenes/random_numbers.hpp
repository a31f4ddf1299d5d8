#pragma once

#include <cstdint>
#include <random>

namespace carom {

struct Point {
    double x;
    double y;
};

/// The generator's random numbers, the same on every platform: the 64-bit Mersenne Twister (Matsumoto and
/// Nishimura 1998; std::mt19937_64, whose output the C++ standard fixes), the upper 53 bits of each output
/// times 2^-53.
class RandomNumbers {
  public:
    explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

    /// least + u (largest - least) with u in [0, 1).
    double uniform(double least, double largest) {
        return least + static_cast<double>(engine_() >> 11) * 0x1p-53 * (largest - least);
    }

    /// A point uniform in the unit circle, by rejection (von Neumann 1951): sines and cosines, which
    /// platforms round differently, are not needed.
    Point in_unit_circle() {
        while (true) {
            const double x = uniform(-1, 1);
            const double y = uniform(-1, 1);
            if (x * x + y * y < 1) {
                return {x, y};
            }
        }
    }

  private:
    std::mt19937_64 engine_;
};

} // namespace carom
