#include "harness/machine/provenance.hpp"

#include <array>
#include <string>

#include <dlfcn.h>
#include <omp.h>

#include "harness/machine/build_info.hpp"
#include "harness/machine/machine.hpp"
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

Json openmp_json() {
    constexpr std::array<const char*, 5> binds{"false", "true", "primary", "close", "spread"};
    const auto bind = static_cast<std::size_t>(omp_get_proc_bind());
    return {{"runtime", openmp_runtime()},
            {"version", _OPENMP},
            {"max_threads", omp_get_max_threads()},
            {"dynamic", omp_get_dynamic() != 0},
            {"proc_bind", bind < binds.size() ? binds[bind] : "unknown"},
            {"places", omp_get_num_places()},
            {"environment", environment_with_prefixes({"OMP_", "GOMP_", "KMP_"})}};
}

/// Of the program that runs, which stays the same: a process that leaves many records reads it once.
const std::string& own_sha256() {
    static const std::string digest = sha256(read_file("/proc/self/exe"));
    return digest;
}

Json slurm_json() {
    const auto variables = environment_with_prefixes(
        {"SLURM_JOB_", "SLURM_ARRAY_", "SLURMD_NODENAME", "SLURM_RESTART_COUNT", "SLURM_CPUS_PER_TASK"});
    return variables.empty() ? Json(nullptr) : Json(variables);
}

} // namespace

std::string commit_text() {
    const std::string commit = build_info::commit;
    if (commit.empty()) {
        return "unknown commit";
    }
    const bool is_changed = std::string(build_info::dirty) == "true";
    return "commit " + commit.substr(0, 12) + (is_changed ? " with changes" : "");
}

Json provenance_json(int threads) {
    // It stays the same, too.
    static const Machine machine = read_machine();
    const std::string dirty = build_info::dirty;
    return {{"host", machine.host},
            {"cpu_model", machine.cpu_model},
            {"cores", or_null(machine.cores)},
            {"hardware_threads", machine.hardware_threads},
            {"affinity", machine.affinity},
            {"affinity_count", machine.affinity_count},
            {"cpu_quota", or_null(machine.cpu_quota)},
            {"oversubscribed", threads > machine.affinity_count},
            {"memory_bytes", machine.memory_bytes},
            {"virtualised", machine.virtualised},
            {"governor", or_null(machine.governor)},
            {"operating_system", machine.operating_system},
            {"openmp", openmp_json()},
            {"compiler", build_info::compiler},
            {"compiler_flags", build_info::flags},
            {"build_type", build_info::build_type},
            {"commit", text_or_null(build_info::commit)},
            {"dirty", dirty.empty() ? Json(nullptr) : Json(dirty == "true")},
            {"diff_sha256", text_or_null(build_info::diff_sha256)},
            {"binary_sha256", own_sha256()},
            {"slurm", slurm_json()}};
}

} // namespace carom
