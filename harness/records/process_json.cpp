#include "harness/records/process_json.hpp"

#include <string_view>

#include "harness/machine/provenance.hpp"
#include "harness/records/record.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/json.hpp"
#include "harness/support/sha256.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

Json openmp_variables(const std::vector<std::string>& environment) {
    Json variables = Json::object();
    for (const std::string& variable : environment) {
        for (const std::string_view prefix : {"OMP_", "GOMP_", "KMP_"}) {
            if (variable.starts_with(prefix)) {
                const auto equals = variable.find('=');
                variables[variable.substr(0, equals)] = variable.substr(equals + 1);
            }
        }
    }
    return variables;
}

std::string hash_of(const Json& sources) {
    if (sources.size() == 1) {
        return sources.front()["sha256"];
    }
    std::string all;
    for (const Json& source : sources) {
        all += source["sha256"].get<std::string>();
    }
    return sha256(all);
}

Json provenance_of(const ProcessMeasurement& measurement) {
    Json provenance = provenance_json(measurement.threads);
    provenance.merge_patch(measurement.build);
    provenance["openmp"]["environment"] = openmp_variables(measurement.command.environment);
    provenance["binary_sha256"] = hash_of(measurement.sources);
    return provenance;
}

Json counters_json(const std::map<std::string, std::optional<double>>& counters) {
    Json json = Json::object();
    for (const auto& [name, value] : counters) {
        json[name] = or_null(value);
    }
    return json;
}

Json turns_json(const ProcessMeasurement& measurement) {
    if (!measurement.turns) {
        return nullptr;
    }
    return {{"contenders", measurement.turns->contenders},
            {"seed", measurement.turns->seed},
            {"seconds", measurement.turns->seconds}};
}

} // namespace

Json sources_json(const std::vector<std::string>& files) {
    Json sources = Json::array();
    for (const std::string& file : files) {
        sources.push_back({{"path", file}, {"sha256", sha256(read_file(file))}});
    }
    return sources;
}

Json process_json(const ProcessMeasurement& measurement) {
    const ProcessEnd& end = measurement.end;
    const double cpu_seconds = end.user_seconds + end.system_seconds;
    const auto& stated = measurement.stated;
    return {{"schema_version", 1},
            {"kind", "process"},
            {"recorded_at", utc_now()},
            {"tags", tags_json(measurement.tags)},
            {"axes", measurement.axes},
            {"scene", measurement.scene},
            {"warm_ups", measurement.warm_ups},
            {"repetitions",
             {{{"steps_seconds", stated ? stated->seconds : end.wall_seconds()},
               {"cpu_seconds", stated ? stated->cpu_seconds : cpu_seconds}}}},
            {"process_seconds", end.wall_seconds()},
            {"process",
             {{"command", measurement.command.words},
              {"folder", measurement.command.folder},
              {"sources", measurement.sources},
              {"exit_code", end.exit_code},
              {"wall_seconds", end.wall_seconds()},
              {"user_seconds", end.user_seconds},
              {"system_seconds", end.system_seconds},
              {"peak_memory_bytes", end.peak_memory_bytes},
              {"time_from", stated ? "the program" : "outside"},
              {"counters", stated ? counters_json(stated->counters) : Json::object()}}},
            {"turns", turns_json(measurement)},
            {"check",
             {{"verdict", measurement.checked.empty() ? "unchecked" : "passed"},
              {"scope", measurement.checked.empty() ? Json("nothing") : Json(measurement.checked)},
              {"reason", nullptr}}},
            {"provenance", provenance_of(measurement)}};
}

} // namespace carom
