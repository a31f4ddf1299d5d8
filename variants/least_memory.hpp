#pragma once

#include <cstdint>

#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// How many bytes a simulation of so many discs in the box of that scene takes at least, on so many threads:
/// the larger part of what it allocates for each disc, each box and each thread, and a copy of the discs at
/// the end. What is found in a step, such as contacts, comes on top of it.
std::int64_t least_memory(const Variant& variant, const Scene& box, std::int64_t discs, int threads);

} // namespace carom
