#pragma once

#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// The variant that is expected to be the fastest for a scene, by the rule in fastest.cpp.
const Variant& fastest_variant(const Scene& scene);

/// The one that is expected to be the fastest for all but the smallest scenes: the last rung of the ladder.
const Variant& fastest_variant();

} // namespace carom
