#pragma once

#include "variants/registry.hpp"

namespace carom {

/// How code was built, in the words of its record.
struct Build {
    const char* compiler;
    const char* flags;
    const char* build_type;
    const char* commit;      ///< empty outside of a repository
    const char* dirty;       ///< "true" if there were changes on top of it, "false", or empty
    const char* diff_sha256; ///< of those changes
};

/// The variants of another build, as the shared library exports them under `other_build_symbol`.
struct ExportedBuild {
    Build build;
    const Variant* (*find_variant)(std::string_view name);
};

inline constexpr auto other_build_symbol = "carom_build";

} // namespace carom
