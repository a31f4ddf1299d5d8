#pragma once

#include <cstdint>

namespace carom {

/// Takes a time in proportion to `loops`: each step needs what the one before gave, so that a processor
/// cannot overlap them, and touches no memory.
inline std::uint64_t loop(std::uint64_t loops) {
    std::uint64_t value = 1;
    for (std::uint64_t k = 0; k < loops; ++k) {
        value = value * 6364136223846793005U + 1442695040888963407U;
        value ^= value >> 29U;
    }
    return value;
}

} // namespace carom
