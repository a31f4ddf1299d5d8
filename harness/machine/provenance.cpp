#include "harness/machine/provenance.hpp"

#include <array>
#include <cstddef>

#include <dlfcn.h>
#include <omp.h>

#include "harness/machine/build_info.hpp"
#include "harness/machine/machine.hpp"
#include "harness/support/environment.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/json.hpp"
#include "harness/support/sha256.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

/// LLVM's runtime also answers to GNU's entry points, so it is asked for first.
std::string openmp_runtime() {
    if (dlsym(RTLD_DEFAULT, "__kmpc_fork_call") != nullptr) {
        return "libomp";
    }
    return dlsym(RTLD_DEFAULT, "GOMP_parallel") != nullptr ? "libgomp" : "unknown";
}

} // namespace

Json openmp_json() {
    constexpr std::array<const char*, 5> binds{"false", "true", "primary", "close", "spread"};
    const auto bind = static_cast<std::size_t>(omp_get_proc_bind());
    return {{"runtime", openmp_runtime()},
            {"version", _OPENMP},
            {"max_threads", omp_get_max_threads()},
            {"dynamic", omp_get_dynamic() != 0},
            {"proc_bind", bind < binds.size() ? binds[bind] : "unknown"},
            {"places", omp_get_num_places()},
            {"environment", variables_with_prefixes({"OMP_", "GOMP_", "KMP_"})}};
}

std::map<std::string, std::string> slurm_variables() {
    return variables_with_prefixes(
        {"SLURM_JOB_", "SLURM_ARRAY_", "SLURMD_NODENAME", "SLURM_RESTART_COUNT", "SLURM_CPUS_PER_TASK"});
}

std::string commit_text(const std::string& unknown) {
    const std::string commit = build_info::commit;
    const bool is_changed = build_info::dirty == std::string_view("true");
    return commit.empty() ? unknown : "commit " + commit.substr(0, 12) + (is_changed ? " with changes" : "");
}

std::string build_text() {
    return std::string(build_info::compiler) + ", " + build_info::build_type + ", " +
           commit_text("commit not known");
}

const Build& this_build() {
    static constexpr Build build{build_info::compiler, build_info::flags, build_info::build_type,
                                 build_info::commit,   build_info::dirty, build_info::diff_sha256};
    return build;
}

Json build_json(const Build& build) {
    const std::string dirty = build.dirty;
    return {{"compiler", build.compiler},
            {"compiler_flags", build.flags},
            {"build_type", build.build_type},
            {"commit", text_or_null(std::string(build.commit))},
            {"dirty", dirty.empty() ? Json(nullptr) : Json(dirty == "true")}};
}

std::string source_of(const Build& build) {
    const std::string changes = build.diff_sha256;
    return "commit " + std::string(build.commit).substr(0, 12) +
           (changes.empty() ? "" : " with changes " + changes.substr(0, 8));
}

const std::string& own_sha256() {
    static const std::string sha = sha256(read_file("/proc/self/exe"));
    return sha;
}

Json provenance_json(int threads) {
    // A process that leaves many records reads once what stays the same.
    static const Json machine = read_machine();
    Json json = machine;
    json["oversubscribed"] = threads > machine["affinity_count"];
    json["openmp"] = openmp_json();
    json.update(build_json());
    json["diff_sha256"] = text_or_null(std::string(build_info::diff_sha256));
    json["binary_sha256"] = own_sha256();
    json["slurm"] = text_or_null(slurm_variables());
    return json;
}

} // namespace carom
