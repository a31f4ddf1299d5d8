#include "harness/doctor/doctor.hpp"

#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

#include "harness/counters/access.hpp"
#include "harness/counters/cachegrind.hpp"
#include "harness/counters/cachegrind_output.hpp"
#include "harness/counters/counters.hpp"
#include "harness/counters/papi.hpp"
#include "harness/counters/rusage.hpp"
#include "harness/machine/machine.hpp"
#include "harness/machine/noise.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/machine/threads.hpp"
#include "harness/machine/topology.hpp"
#include "harness/support/child_process.hpp"
#include "harness/support/json.hpp"
#include "harness/support/silence.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

/// A field of /proc/meminfo in bytes.
std::optional<std::int64_t> memory_bytes(const std::string& field) {
    std::ifstream file("/proc/meminfo");
    for (std::string line; std::getline(file, line);) {
        std::istringstream fields(line);
        std::string name;
        std::int64_t kibibytes = 0;
        if (fields >> name >> kibibytes && name == field + ":") {
            return kibibytes * 1024;
        }
    }
    return std::nullopt;
}

Json topology_json() {
    const Topology topology = read_topology();
    Json caches = Json::array();
    for (const CacheLevel& cache : topology.caches) {
        caches.push_back({{"name", cache.name},
                          {"bytes", cache.bytes},
                          {"count", cache.count},
                          {"hardware_threads", cache.hardware_threads}});
    }
    const Json smt = topology.cores ? Json(topology.hardware_threads > *topology.cores) : Json(nullptr);
    return {{"source", topology.source},
            {"packages", or_null(topology.packages)},
            {"cores", or_null(topology.cores)},
            {"hardware_threads", topology.hardware_threads},
            {"smt", smt},
            {"numa_nodes", or_null(topology.numa_nodes)},
            {"caches", caches}};
}

/// Whether the CPU may run above its nominal frequency, as far as the system tells.
std::optional<bool> turbo() {
    if (const auto off = first_line("/sys/devices/system/cpu/intel_pstate/no_turbo")) {
        return *off == "0";
    }
    if (const auto on = first_line("/sys/devices/system/cpu/cpufreq/boost")) {
        return *on == "1";
    }
    return std::nullopt;
}

/// One source: the events that it counts, in how many runs, and what it cannot count and why.
Json source_json(const std::string& source, const CounterPlan& plan) {
    std::vector<std::string> events;
    int runs = 0;
    for (const CounterGroup& group : plan.groups) {
        if (group.source == source) {
            ++runs;
            events.insert(events.end(), group.events.begin(), group.events.end());
        }
    }
    Json missing = Json::array();
    for (const CounterValue& value : plan.missing) {
        if (value.source == source) {
            missing.push_back({{"event", value.name}, {"reason", value.reason}, {"remedy", value.remedy}});
        }
    }
    return {{"source", source}, {"events", events}, {"runs", runs}, {"missing", missing}};
}

CounterPlan plan_all_sources() {
    CounterPlan plan = plan_counters({});
    plan.groups.push_back({"rusage", rusage_events(), rusage_event_set});
    const bool simulated = !valgrind_version().empty();
    if (simulated) {
        plan.groups.push_back({"cachegrind", {}, {}});
    }
    for (const SimulatedName& name : simulated_counts()) {
        const std::string event(name.counter);
        if (simulated) {
            plan.groups.back().events.push_back(event);
        } else {
            plan.missing.push_back({event, {}, {}, "cachegrind", no_valgrind().reason, no_valgrind().remedy});
        }
    }
    return plan;
}

Json counters_json() {
    const CounterPlan plan = plan_all_sources();
    Json counters = Json::array();
    for (const char* source : {"papi-hardware", "papi-software", "rusage", "cachegrind"}) {
        counters.push_back(source_json(source, plan));
    }
    return counters;
}

/// The first line of what a program says of its version, or null if it is not on PATH.
Json version_of(const std::string& program) {
    const ChildEnd end = run_child({program, "--version"});
    return end.succeeded() ? text_or_null(end.output.substr(0, end.output.find('\n'))) : Json(nullptr);
}

Json tools_json() {
    Json tools = Json::object();
    for (const char* program : {"g++", "clang++", "valgrind", "perf"}) {
        tools[program] = version_of(program);
    }
    return tools;
}

Json perf_json() {
    const PerfAccess access = read_perf_access();
    return {{"papi", papi_version()}, {"paranoid", or_null(access.paranoid)}, {"pmu", !lacks_pmu(access)}};
}

Json noise_json(double seconds) {
    const Noise noise = measure_noise(seconds);
    return {{"spins", noise.spins},
            {"median_seconds", noise.median_seconds},
            {"p95_over_median", noise.p95_over_median},
            {"max_over_median", noise.max_over_median},
            {"steal", or_null(noise.steal)}};
}

Json picked_from(const Json& provenance, std::initializer_list<const char*> fields) {
    Json json = Json::object();
    for (const char* field : fields) {
        json[field] = provenance[field];
    }
    return json;
}

Json program_json(const Json& provenance) {
    return picked_from(provenance, {"compiler", "compiler_flags", "build_type", "commit", "dirty"});
}

} // namespace

Json build_json() {
    const Json provenance = provenance_json(1);
    Json build = program_json(provenance);
    build["openmp"] = {{"runtime", provenance["openmp"]["runtime"]}};
    return build;
}

Json doctor_json(double noise_seconds) {
    const Silence silence;
    const Json provenance = provenance_json(1);
    const auto picked = [&provenance](std::initializer_list<const char*> fields) {
        return picked_from(provenance, fields);
    };
    Json machine = picked({"host", "operating_system", "cpu_model", "virtualised", "memory_bytes"});
    machine["memory_available_bytes"] = or_null(memory_bytes("MemAvailable"));
    Json affinity = picked({"affinity", "affinity_count", "hardware_threads", "cpu_quota"});
    affinity["usable_processors"] = usable_processors();
    affinity["threads_by_default"] = default_threads();
    // Noise comes first: what follows starts programs, which may still be at work.
    Json noise = noise_json(noise_seconds);
    return {{"machine", machine},
            {"topology", topology_json()},
            {"frequency", {{"governor", provenance["governor"]}, {"turbo", or_null(turbo())}}},
            {"affinity", affinity},
            {"openmp", provenance["openmp"]},
            {"perf_events", perf_json()},
            {"counters", counters_json()},
            {"program", program_json(provenance)},
            {"tools", tools_json()},
            {"slurm", {{"version", version_of("srun")}, {"job", provenance["slurm"]}}},
            {"noise", noise}};
}

} // namespace carom
