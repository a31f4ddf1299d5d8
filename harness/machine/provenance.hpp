#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace carom {

/// Where a record comes from: machine, affinity, OpenMP runtime, compiler, commit, binary, Slurm job; as the
/// record schema's `provenance`. `threads` tells whether the affinity mask is oversubscribed.
nlohmann::ordered_json provenance_json(int threads);

/// The commit that the program was built from, as "commit 0123456789ab", "with changes" behind it if its
/// source had any; "unknown commit" for one built outside of a repository.
std::string commit_text();

} // namespace carom
