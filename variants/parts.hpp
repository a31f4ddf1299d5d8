#pragma once

#include <cstddef>
#include <span>

#include "variants/registry.hpp"

namespace carom {

/// Every variant is the whole step compiled anew: they are spread over so many translation units, which
/// processors compile side by side.
inline constexpr std::size_t parts = 4;

/// The rows `part`, `part + parts`, `part + 2 parts` ... of the table, as they can be run. Instantiated in
/// the file of the part, from variants/registry_part.hpp.
template <std::size_t part> std::span<const Variant> variants_of_part();

} // namespace carom
