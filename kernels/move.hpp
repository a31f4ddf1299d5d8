#pragma once

#include <algorithm>
#include <cstddef>

#include "parallel_for.hpp"
#include "policies.hpp"
#include "state.hpp"

namespace carom {

/// Moves every disc freely, x += v dt. On one thread, as the published program does.
template <Policies policies, class SomeProbe>
    requires(policies.storage == Storage::numbered)
void move(State<policies>& state, const Tuning& tuning, SomeProbe& /*probe*/) {
    using Real = typename State<policies>::Real;
    const Real dt = Real{1} / static_cast<Real>(tuning.substeps);
    for (BasicDisc<Real>& disc : state.discs) {
        disc.x += disc.vx * dt;
        disc.y += disc.vy * dt;
    }
}

/// The same on all threads, noting the box that a disc comes to lie in.
template <Policies policies, class SomeProbe>
    requires(policies.storage == Storage::sorted)
void move(State<policies>& state, const Tuning& tuning, SomeProbe& probe) {
    using Real = typename State<policies>::Real;
    constexpr int discs_at_a_time = 256;
    const Real dt = Real{1} / static_cast<Real>(tuning.substeps);
    const int count = state.count();
    const int iterations = (count + discs_at_a_time - 1) / discs_at_a_time;
    parallel_for<Schedule::static_>(tuning.threads, iterations, 1, probe, [&](int k) {
        for (int i = k * discs_at_a_time; i < std::min((k + 1) * discs_at_a_time, count); ++i) {
            BasicDisc<Real>& disc = state.disc(i);
            disc.x += disc.vx * dt;
            disc.y += disc.vy * dt;
            state.box_of_disc[static_cast<std::size_t>(i)] =
                state.grid.box_of(state.grid.coordinate(disc.y), state.grid.coordinate(disc.x));
        }
    });
}

} // namespace carom
