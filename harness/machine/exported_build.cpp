// The shared library of a build's variants (build/*/carom-variants.so): all that another build sees of it.

#include "harness/machine/build.hpp"
#include "harness/machine/build_info.hpp"

extern "C" {

/// Named by `other_build_symbol`.
[[gnu::visibility("default")]] extern const carom::ExportedBuild carom_build;

const carom::ExportedBuild carom_build{{carom::build_info::compiler, carom::build_info::flags,
                                        carom::build_info::build_type, carom::build_info::commit,
                                        carom::build_info::dirty, carom::build_info::diff_sha256},
                                       carom::find_variant};
}
