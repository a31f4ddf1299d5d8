#include "harness/accuracy/costs.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kernels/grid.hpp"

namespace carom {
namespace {

/// What a unit of each kind of work takes in a scene of so many discs.
struct UnitCosts {
    double discs;
    Work nanoseconds;

    double seconds(const Work& work) const {
        return 1e-9 * (nanoseconds.placed * work.placed + nanoseconds.moved * work.moved +
                       nanoseconds.near * work.near + nanoseconds.collisions * work.collisions);
    }
};

/// As measured on one machine: small scenes in a cache, and large ones.
std::vector<UnitCosts> costs_of(const Variant& variant) {
    if (variant.engine == Engine::event_driven) {
        return {{2'000, {100, 120, 0, 300}}, {40'000, {150, 150, 0, 380}}, {400'000, {400, 240, 50, 600}}};
    }
    const double collision = variant.policies.impact == Impact::at_contact ? 75 : 20;
    return {{40'000, {3, 0, 3.5, collision}}, {400'000, {13, 10, 4, 2 * collision}}};
}

} // namespace

Work& Work::operator+=(const Work& more) {
    placed += more.placed;
    moved += more.moved;
    near += more.near;
    collisions += more.collisions;
    return *this;
}

Work operator*(double times, const Work& work) {
    return {times * work.placed, times * work.moved, times * work.near, times * work.collisions};
}

double seconds_of(const Variant& variant, double discs, const Work& work) {
    const std::vector<UnitCosts> sizes = costs_of(variant);
    const auto larger = std::ranges::find_if(sizes, [&](const UnitCosts& one) { return one.discs >= discs; });
    if (larger == sizes.begin() || larger == sizes.end()) {
        return (larger == sizes.end() ? sizes.back() : sizes.front()).seconds(work);
    }
    const UnitCosts& smaller = *(larger - 1);
    const double share = std::log(discs / smaller.discs) / std::log(larger->discs / smaller.discs);
    return (1 - share) * smaller.seconds(work) + share * larger->seconds(work);
}

Work work_of_step(const Variant& variant, const Scene& scene) {
    const auto count = static_cast<double>(scene.discs.size());
    const Grid grid(scene.side, scene.radius, static_cast<int>(scene.discs.size()),
                    variant.policies.box_side);
    std::vector<double> held(static_cast<std::size_t>(grid.box_count()), 0.0);
    for (const Disc& disc : scene.discs) {
        const int box = grid.box_of(grid.coordinate(disc.y), grid.coordinate(disc.x));
        ++held[static_cast<std::size_t>(box)];
    }
    double squares = 0;
    for (const double discs : held) {
        squares += discs * discs;
    }
    return {.moved = count, .near = 4.5 * squares}; // half of nine boxes
}

Work work_of_events(const Scene& scene) {
    const auto count = static_cast<double>(scene.discs.size());
    const double cell = std::max(2 * scene.radius, scene.side / std::sqrt(count + 1));
    double flown = 0;
    for (const Disc& disc : scene.discs) {
        flown += std::abs(disc.vx) + std::abs(disc.vy);
    }
    return {.moved = flown / cell, .near = count};
}

} // namespace carom
