#pragma once

#include <gtest/gtest.h>

#include "kernels/scene.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom::tests {

/// The same to the last bit.
inline testing::AssertionResult same_scene(const Scene& one, const Scene& two) {
    if (!same_bits(one.side, two.side) || !same_bits(one.radius, two.radius) || one.steps != two.steps) {
        return testing::AssertionFailure()
               << "L " << one.side << " against " << two.side << ", r " << one.radius << " against "
               << two.radius << ", S " << one.steps << " against " << two.steps;
    }
    return same_bits(one.discs, two.discs);
}

} // namespace carom::tests
