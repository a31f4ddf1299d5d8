#include "variants/registry_part.hpp"

template std::span<const carom::Variant> carom::variants_of_part<2>();
