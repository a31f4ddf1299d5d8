#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "kernels/exact/flight.hpp"
#include "kernels/exact/tile_grid.hpp"

namespace carom {

/// The numbers of all discs of a box in an order in which those that are near each other in space mostly are
/// so in memory: along a Z through ever smaller quarters of the box (Morton, "A computer oriented geodetic
/// data base", IBM, Ottawa, 1966).
template <class Real>
std::vector<int> memory_order(const std::vector<Flight<Real>>& flights, Real now, Real box_side) {
    constexpr int bits = 16;
    const auto along = [&](Real at) {
        const Real scaled = at / box_side * static_cast<Real>(1 << bits);
        return static_cast<std::uint64_t>(std::clamp(scaled, Real(0), static_cast<Real>((1 << bits) - 1)));
    };
    std::vector<std::pair<std::uint64_t, int>> keys;
    keys.reserve(flights.size());
    for (const Flight<Real>& one : flights) {
        const auto [x, y] = position(one, now);
        std::uint64_t key = 0;
        for (int bit = 0; bit < bits; ++bit) {
            key |= ((along(x) >> bit & 1U) << (2 * bit)) | ((along(y) >> bit & 1U) << (2 * bit + 1));
        }
        keys.emplace_back(key, static_cast<int>(keys.size()));
    }
    std::ranges::sort(keys);
    std::vector<int> order;
    order.reserve(keys.size());
    for (const auto& [key, disc] : keys) {
        order.push_back(disc);
    }
    return order;
}

} // namespace carom
