#pragma once

#include <map>
#include <string>

#include <nlohmann/json.hpp>

namespace carom {

/// The OpenMP runtime of this process.
struct OpenMp {
    std::string runtime; ///< libgomp, libomp or unknown
    int version = 0;     ///< of the specification, as year and month
    int max_threads = 1;
    bool dynamic = false;
    std::string proc_bind;
    int places = 0;
    std::map<std::string, std::string> environment; ///< its variables that are set
};
OpenMp read_openmp();

/// The variables of the Slurm job that this process is in; none outside of one.
std::map<std::string, std::string> slurm_variables();

/// Where a record comes from: machine, affinity, OpenMP runtime, compiler, commit, binary, Slurm job; as the
/// record schema's `provenance`. `threads` tells whether the affinity mask is oversubscribed.
nlohmann::ordered_json provenance_json(int threads);

/// What it says of the OpenMP runtime.
nlohmann::ordered_json openmp_json(const OpenMp& openmp);

/// What it says of how the program was built.
nlohmann::ordered_json build_json();

/// How the program was built, for a reader: compiler, type of the build, commit.
std::string build_text();

/// The commit that the program was built from, as "commit 0123456789ab", "with changes" behind it if its
/// source had any; `unknown` for one built outside of a repository.
std::string commit_text(const std::string& unknown = "unknown commit");

} // namespace carom
