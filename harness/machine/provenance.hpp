#pragma once

#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "harness/machine/build.hpp"

namespace carom {

/// The variables of the Slurm job that this process is in; none outside of one.
std::map<std::string, std::string> slurm_variables();

/// Where a record comes from: machine, affinity, OpenMP runtime, compiler, commit, binary, Slurm job; as the
/// record schema's `provenance`. `threads` tells whether the affinity mask is oversubscribed.
nlohmann::ordered_json provenance_json(int threads);

/// What it says of the OpenMP runtime of this process.
nlohmann::ordered_json openmp_json();

/// How this program was built.
const Build& this_build();

/// What it says of how code was built.
nlohmann::ordered_json build_json(const Build& build = this_build());

/// Which source it was built from: the commit, with the hash of what was changed on top of it.
std::string source_of(const Build& build);

/// The SHA-256 of this program's file.
const std::string& own_sha256();

/// How the program was built, for a reader: compiler, type of the build, commit.
std::string build_text();

/// The commit that the program was built from, as "commit 0123456789ab", "with changes" behind it if its
/// source had any; `unknown` for one built outside of a repository.
std::string commit_text(const std::string& unknown = "unknown commit");

} // namespace carom
