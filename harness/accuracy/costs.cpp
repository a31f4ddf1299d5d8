#include "harness/accuracy/costs.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kernels/grid.hpp"

namespace carom {
namespace {

struct Measured {
    double discs;
    std::array<double, 4> nanoseconds;
};

/// Small scenes, in a cache, and large ones.
std::vector<Measured> measured_costs(const Variant& variant) {
    if (variant.engine == Engine::event_driven) {
        return {{2'000, {100, 120, 0, 300}}, {40'000, {150, 150, 0, 380}}, {400'000, {400, 240, 50, 600}}};
    }
    const double collision = variant.policies.impact == Impact::at_contact ? 75 : 20;
    return {{40'000, {3, 0, 3.5, collision}}, {400'000, {13, 10, 4, 2 * collision}}};
}

} // namespace

Costs::Costs(const Variant& variant, std::size_t discs) : variant_(variant) {
    const std::vector<Measured> sizes = measured_costs(variant);
    const auto count = static_cast<double>(discs);
    auto larger = sizes.begin() + 1;
    while (larger + 1 != sizes.end() && larger->discs < count) {
        ++larger;
    }
    const Measured& smaller = *(larger - 1);
    const double beyond = std::log(count / smaller.discs) / std::log(larger->discs / smaller.discs);
    for (std::size_t kind = 0; kind < nanoseconds_.size(); ++kind) {
        nanoseconds_[kind] =
            std::lerp(smaller.nanoseconds[kind], larger->nanoseconds[kind], std::clamp(beyond, 0.0, 1.0));
    }
}

double Costs::setting_up(const Scene& scene) const {
    return 1e-9 * nanoseconds_[0] * static_cast<double>(scene.discs.size());
}

double Costs::step(const Scene& scene) const {
    const auto count = static_cast<double>(scene.discs.size());
    if (variant_.engine == Engine::steps) {
        return 1e-9 * (nanoseconds_[1] * count + nanoseconds_[2] * near_in_steps(scene));
    }
    const double cell = std::max(2 * scene.radius, scene.side / std::sqrt(count + 1));
    double flown = 0;
    for (const Disc& disc : scene.discs) {
        flown += std::abs(disc.vx) + std::abs(disc.vy);
    }
    return 1e-9 * (nanoseconds_[1] * flown / cell + nanoseconds_[2] * count);
}

double Costs::collisions(std::int64_t count) const {
    return 1e-9 * nanoseconds_[3] * static_cast<double>(count);
}

/// Pairs of discs in half of the nine boxes around each.
double Costs::near_in_steps(const Scene& scene) const {
    const Grid grid(scene.side, scene.radius, static_cast<int>(scene.discs.size()),
                    variant_.policies.box_side);
    std::vector<double> held(static_cast<std::size_t>(grid.box_count()), 0.0);
    double pairs = 0;
    for (const Disc& disc : scene.discs) {
        const int box = grid.box_of(grid.coordinate(disc.y), grid.coordinate(disc.x));
        const double before = held[static_cast<std::size_t>(box)]++;
        pairs += 2 * before + 1; // the square of how many there are
    }
    return 4.5 * pairs;
}

} // namespace carom
