#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "variants/registry.hpp"

namespace carom {

/// The variant of that name in the shared library that another build of the same source has made of its
/// variants (carom-variants.so), loaded once and never let go. So the code of two compilers takes turns in
/// one process, on one pool of threads. Throws InputError for a file that is no such library, or one of
/// another source, whose types may differ, and for a variant that it lacks.
const Variant& variant_of_build(const std::string& library, std::string_view name);

/// What a record says of the code of that library, which is loaded: compiler, flags, hash.
nlohmann::ordered_json provenance_of_build(const std::string& library);

} // namespace carom
