#include "harness/doctor/findings.hpp"
#include "harness/support/json.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

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

Json affinity_json(const Findings& findings) {
    const Machine& machine = findings.machine;
    return {{"affinity", machine.affinity},
            {"affinity_count", machine.affinity_count},
            {"hardware_threads", machine.hardware_threads},
            {"cpu_quota", or_null(machine.cpu_quota)},
            {"usable_processors", findings.usable_processors},
            {"threads_by_default", findings.threads_by_default}};
}

Json counters_json(const std::vector<CounterSource>& sources) {
    Json counters = Json::array();
    for (const CounterSource& source : sources) {
        Json missing = Json::array();
        for (const CounterValue& value : source.missing) {
            missing.push_back({{"event", value.name}, {"reason", value.reason}, {"remedy", value.remedy}});
        }
        counters.push_back({{"source", source.name},
                            {"events", source.events},
                            {"runs", source.runs},
                            {"missing", missing}});
    }
    return counters;
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

} // namespace

Json doctor_json(const Findings& findings) {
    const Machine& machine = findings.machine;
    const PerfAccess& perf = findings.perf;
    Json tools = Json::object();
    for (const Tool& tool : findings.tools) {
        tools[tool.name] = text_or_null(tool.version);
    }
    return {{"machine",
             {{"host", machine.host},
              {"operating_system", machine.operating_system},
              {"cpu_model", machine.cpu_model},
              {"virtualised", machine.virtualised},
              {"memory_bytes", machine.memory_bytes},
              {"memory_available_bytes", or_null(findings.memory_available_bytes)}}},
            {"topology", topology_json(findings.topology)},
            {"frequency", {{"governor", or_null(machine.governor)}, {"turbo", or_null(findings.turbo)}}},
            {"affinity", affinity_json(findings)},
            {"openmp", openmp_json(findings.openmp)},
            {"perf_events",
             {{"papi", findings.papi}, {"paranoid", or_null(perf.paranoid)}, {"pmu", !lacks_pmu(perf)}}},
            {"counters", counters_json(findings.counters)},
            {"program", build_json()},
            {"tools", tools},
            {"slurm",
             {{"version", text_or_null(findings.slurm_version)}, {"job", text_or_null(findings.slurm_job)}}},
            {"noise", noise_json(findings.noise)}};
}

} // namespace carom
