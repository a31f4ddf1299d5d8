#include "harness/records/process_json.hpp"

#include <map>
#include <string_view>

#include "harness/machine/provenance.hpp"
#include "harness/records/record.hpp"
#include "harness/support/json.hpp"

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

Json provenance_of(const ProcessMeasurement& measurement) {
    Json provenance = provenance_json(measurement.threads);
    provenance.merge_patch(measurement.build);
    provenance["openmp"]["environment"] = openmp_variables(measurement.command.environment);
    provenance["binary_sha256"] = measurement.sources.hash();
    return provenance;
}

Json turns_json(const ProcessMeasurement& measurement) {
    if (!measurement.turns) {
        return nullptr;
    }
    return {{"contenders", measurement.turns->contenders},
            {"seed", measurement.turns->seed},
            {"seconds", measurement.turns->seconds},
            {"seconds_alone", measurement.measured.seconds_alone}};
}

/// The mean of each.
Json counters_json(const std::vector<StatedTime>& stated) {
    std::map<std::string, double> sums;
    for (const StatedTime& one : stated) {
        for (const auto& [name, value] : one.counters) {
            sums[name] += value;
        }
    }
    Json counters = Json::object();
    for (const auto& [name, sum] : sums) {
        counters[name] = sum / static_cast<double>(stated.size());
    }
    return counters;
}

/// A time for each run: the one that the program says, or the one from outside.
Json repetitions_json(const ProcessMeasurement& measurement) {
    Json repetitions = Json::array();
    for (std::size_t k = 0; k < measurement.measured.runs.size(); ++k) {
        const ProcessEnd& end = measurement.measured.runs[k];
        const bool says = !measurement.stated.empty();
        repetitions.push_back(
            {{"steps_seconds", says ? measurement.stated[k].seconds : end.wall_seconds()},
             {"cpu_seconds", says ? measurement.stated[k].cpu_seconds : end.cpu_seconds()}});
    }
    return repetitions;
}

/// Of the last run; what adds up is that of all runs.
Json ends_json(const ProcessMeasurement& measurement) {
    const std::vector<ProcessEnd>& runs = measurement.measured.runs;
    const ProcessEnd& last = runs.back();
    const auto sum = [&runs](auto value) {
        double all = 0;
        for (const ProcessEnd& run : runs) {
            all += value(run);
        }
        return all;
    };
    return {{"exit_code", last.exit_code},
            {"wall_seconds", sum([](const ProcessEnd& end) { return end.wall_seconds(); })},
            {"user_seconds", sum([](const ProcessEnd& end) { return end.user_seconds; })},
            {"system_seconds", sum([](const ProcessEnd& end) { return end.system_seconds; })},
            {"runs", runs.size()},
            {"peak_memory_bytes", or_null(last.peak_memory_bytes)},
            {"peak_memory_reason", last.memory_of},
            {"output_bytes", last.output.bytes + last.error.bytes},
            {"tree", last.kept_by},
            {"ran_on", last.ran_on},
            {"undisturbed", text_or_null(measurement.measured.undisturbed)}};
}

} // namespace

Json process_json(const ProcessMeasurement& measurement) {
    Json process{{"command", measurement.command.words},
                 {"folder", measurement.command.folder},
                 {"sources", measurement.sources.json()},
                 {"changed", measurement.sources.changed()},
                 {"time_from", measurement.stated.empty() ? "outside" : "the program"},
                 {"counters", counters_json(measurement.stated)}};
    process.update(ends_json(measurement));
    return {{"schema_version", 1},
            {"kind", "process"},
            {"recorded_at", utc_now()},
            {"tags", tags_json(measurement.tags)},
            {"axes", measurement.axes},
            {"scene", measurement.scene},
            {"warm_ups", measurement.warm_ups},
            {"repetitions", repetitions_json(measurement)},
            {"process_seconds", process["wall_seconds"]},
            {"process", process},
            {"turns", turns_json(measurement)},
            {"check",
             {{"verdict", measurement.checked.empty() ? "unchecked" : "passed"},
              {"scope", measurement.checked.empty() ? Json("nothing") : Json(measurement.checked)},
              {"reason", nullptr}}},
            {"provenance", provenance_of(measurement)}};
}

} // namespace carom
