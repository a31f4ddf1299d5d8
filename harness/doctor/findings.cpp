#include "harness/doctor/findings.hpp"

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "harness/counters/access.hpp"
#include "harness/counters/cachegrind.hpp"
#include "harness/counters/counters.hpp"
#include "harness/counters/papi.hpp"
#include "harness/counters/rusage.hpp"
#include "harness/machine/machine.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/machine/threads.hpp"
#include "harness/machine/topology.hpp"
#include "harness/processes/process.hpp"
#include "harness/support/free_memory.hpp"
#include "harness/support/json.hpp"
#include "harness/support/silence.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

std::optional<bool> read_turbo() {
    const auto off = first_line("/sys/devices/system/cpu/intel_pstate/no_turbo");
    const auto on = first_line("/sys/devices/system/cpu/cpufreq/boost");
    return off ? std::optional(*off == "0") : on ? std::optional(*on == "1") : std::nullopt;
}

Json some_of(const Json& all, std::initializer_list<const char*> fields) {
    Json some = Json::object();
    for (const char* field : fields) {
        some[field] = all[field];
    }
    return some;
}

Json topology_json(const Topology& topology) {
    Json caches = Json::array();
    for (const CacheLevel& cache : topology.caches) {
        caches.push_back({{"name", cache.name},
                          {"bytes", cache.bytes},
                          {"count", cache.count},
                          {"hardware_threads", cache.hardware_threads}});
    }
    return {{"source", topology.source},
            {"packages", or_null(topology.packages)},
            {"cores", or_null(topology.cores)},
            {"hardware_threads", topology.hardware_threads},
            {"smt", or_null(topology.smt())},
            {"numa_nodes", or_null(topology.numa_nodes)},
            {"caches", caches}};
}

/// A source of counters: the events that it counts, in how many runs, and those that it cannot count and why.
Json source_json(const std::string& name, const std::vector<CounterGroup>& groups,
                 const std::vector<CounterValue>& missing) {
    Json source{{"source", name}, {"events", Json::array()}, {"runs", 0}, {"missing", Json::array()}};
    for (const CounterGroup& group : groups) {
        if (group.source == name) {
            source["runs"] = source["runs"].get<int>() + 1;
            for (const std::string& event : group.events) {
                source["events"].push_back(event);
            }
        }
    }
    for (const CounterValue& value : missing) {
        if (value.source == name) {
            source["missing"].push_back(
                {{"event", value.name}, {"reason", value.reason}, {"remedy", value.remedy}});
        }
    }
    return source;
}

Json counters_json() {
    auto [groups, missing] = plan_counters({});
    groups.push_back({"rusage", rusage_events(), nullptr});
    if (valgrind_version().empty()) {
        const auto [reason, remedy] = no_valgrind();
        for (const std::string& name : simulated_counts()) {
            missing.push_back({name, {}, {}, "cachegrind", reason, remedy});
        }
    } else {
        groups.push_back({"cachegrind", simulated_counts(), nullptr});
    }
    Json sources = Json::array();
    for (const char* name : {"papi-hardware", "papi-software", "rusage", "cachegrind"}) {
        sources.push_back(source_json(name, groups, missing));
    }
    return sources;
}

Json noise_json(const Noise& noise) {
    Json neighbours = Json::array();
    for (const Neighbours& one : noise.neighbours) {
        neighbours.push_back({{"seconds", one.seconds}, {"difference", one.difference}});
    }
    return {{"spins", noise.spins},
            {"median_seconds", noise.median_seconds},
            {"p95_over_median", noise.p95_over_median},
            {"max_over_median", noise.max_over_median},
            {"steal", or_null(noise.steal)},
            {"neighbours", neighbours}};
}

Json tools_json() {
    Json tools = Json::object();
    for (const char* name : {"g++", "clang++", "valgrind", "perf"}) {
        tools[name] = text_or_null(version_line(name));
    }
    return tools;
}

} // namespace

Json examine_machine(double noise_seconds) {
    const Silence silence;
    // Noise comes first: what follows starts programs, which may still be at work.
    const Noise noise = measure_noise(noise_seconds);
    const Json told = read_machine();
    Json machine = some_of(told, {"host", "operating_system", "cpu_model", "virtualised", "memory_bytes"});
    machine["memory_available_bytes"] = or_null(available_memory());
    Json affinity = some_of(told, {"affinity", "affinity_count", "hardware_threads", "cpu_quota"});
    affinity["usable_processors"] = usable_processors();
    affinity["threads_by_default"] = default_threads();
    const PerfAccess perf = read_perf_access();
    return {{"machine", machine},
            {"topology", topology_json(read_topology())},
            {"frequency", {{"governor", told["governor"]}, {"turbo", or_null(read_turbo())}}},
            {"affinity", affinity},
            {"openmp", openmp_json()},
            {"perf_events",
             {{"papi", papi_version()}, {"paranoid", or_null(perf.paranoid)}, {"pmu", !lacks_pmu(perf)}}},
            {"counters", counters_json()},
            {"program", build_json()},
            {"tools", tools_json()},
            {"slurm",
             {{"version", text_or_null(version_line("srun"))}, {"job", text_or_null(slurm_variables())}}},
            {"noise", noise_json(noise)}};
}

} // namespace carom
