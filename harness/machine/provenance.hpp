#pragma once

#include <nlohmann/json.hpp>

namespace carom {

/// Where a record comes from: machine, affinity, OpenMP runtime, compiler, commit, binary, Slurm job; as the
/// record schema's `provenance`. `threads` tells whether the affinity mask is oversubscribed.
nlohmann::ordered_json provenance_json(int threads);

} // namespace carom
