#pragma once

#include <bit>
#include <cstdint>
#include <ostream>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/policies.hpp"
#include "kernels/probe.hpp"
#include "kernels/scene.hpp"
#include "kernels/state.hpp"
#include "kernels/step.hpp"
#include "kernels/tests/all_pairs.hpp"

namespace carom {

inline std::ostream& operator<<(std::ostream& stream, const Disc& disc) {
    const auto precision = stream.precision(17);
    stream << "(" << disc.x << ", " << disc.y << "), velocity (" << disc.vx << ", " << disc.vy << ")";
    stream.precision(precision);
    return stream;
}

} // namespace carom

namespace carom::tests {

/// The end of a run and the work of all its steps.
struct Outcome {
    std::vector<Disc> discs;
    Tally work;
};

/// Runs all steps of a scene.
template <Policies policies> Outcome simulate(const Scene& scene, const Tuning& tuning = {}) {
    State<policies> state(scene);
    NoProbe probe;
    Tally work;
    for (int step = 0; step < scene.steps * tuning.substeps; ++step) {
        work += carom::step<policies>(state, tuning, probe);
    }
    return {discs_by_number(state), work};
}

/// The same by the reference.
inline Outcome simulate_all_pairs(const Scene& scene, const Policies& policies, const Tuning& tuning = {}) {
    AllPairs reference(scene, policies, tuning);
    Tally work;
    for (int step = 0; step < scene.steps * tuning.substeps; ++step) {
        work += reference.step();
    }
    return {reference.discs(), work};
}

inline bool same_bits(double one, double two) {
    return std::bit_cast<std::uint64_t>(one) == std::bit_cast<std::uint64_t>(two);
}

inline bool same_bits(const Disc& one, const Disc& two) {
    return same_bits(one.x, two.x) && same_bits(one.y, two.y) && same_bits(one.vx, two.vx) &&
           same_bits(one.vy, two.vy);
}

/// Are the states the same to the last bit, the sign of a zero included? Names the first disc that is not.
inline testing::AssertionResult same_bits(const std::vector<Disc>& one, const std::vector<Disc>& two) {
    if (one.size() != two.size()) {
        return testing::AssertionFailure() << one.size() << " discs against " << two.size();
    }
    for (std::size_t i = 0; i < one.size(); ++i) {
        if (!same_bits(one[i], two[i])) {
            return testing::AssertionFailure() << "disc " << i << ": " << one[i] << " against " << two[i];
        }
    }
    return testing::AssertionSuccess();
}

} // namespace carom::tests
