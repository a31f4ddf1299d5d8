#pragma once

#include <algorithm>
#include <cstddef>

#include "parallel_for.hpp"
#include "policies.hpp"
#include "state.hpp"

namespace carom {

/// Moves every disc freely, x += v dt, and notes the box that it comes to lie in.
template <Policies policies, class SomeProbe>
void move(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    using Real = typename State<policies>::Real;
    constexpr int block = 1024;
    const Real dt = Real{1} / static_cast<Real>(tuning.substeps);
    const int count = state.count();
    const int blocks = (count + block - 1) / block;
    parallel_for<Schedule::static_>(tuning.threads, blocks, 1, probe, [&](int k) {
        for (int i = k * block; i < std::min((k + 1) * block, count); ++i) {
            BasicDisc<Real>& disc = state.discs[static_cast<std::size_t>(i)];
            disc.x += disc.vx * dt;
            disc.y += disc.vy * dt;
            state.box_of_disc[static_cast<std::size_t>(i)] =
                state.grid.box_of(state.grid.coordinate(disc.y), state.grid.coordinate(disc.x));
        }
        return Tally{};
    });
}

} // namespace carom
