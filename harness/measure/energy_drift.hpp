#pragma once

#include <optional>
#include <vector>

#include "kernels/scene.hpp"

namespace carom {

/// (E_end - E_start) / E_start; empty if nothing moves at the start.
std::optional<double> energy_drift(const Scene& scene, const std::vector<Disc>& discs);

/// How many centres lie outside [0, L]^2.
int discs_outside(const Scene& scene, const std::vector<Disc>& discs);

} // namespace carom
