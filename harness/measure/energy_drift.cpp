#include "harness/measure/energy_drift.hpp"

#include <algorithm>

#include "harness/verify/checker.hpp"

namespace carom {

std::optional<double> energy_drift(const Scene& scene, const std::vector<Disc>& discs) {
    const double start = kinetic_energy(scene.discs);
    if (start == 0) {
        return std::nullopt;
    }
    return (kinetic_energy(discs) - start) / start;
}

int discs_outside(const Scene& scene, const std::vector<Disc>& discs) {
    const auto outside = [&scene](const Disc& disc) {
        return !(disc.x >= 0 && disc.y >= 0 && disc.x <= scene.side && disc.y <= scene.side);
    };
    return static_cast<int>(std::count_if(discs.begin(), discs.end(), outside));
}

} // namespace carom
