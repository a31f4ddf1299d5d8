#include "harness/records/process_json.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>

#include "harness/machine/provenance.hpp"
#include "harness/records/record.hpp"
#include "harness/support/json.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

Json provenance_of(const ProcessMeasurement& measurement) {
    Json provenance = provenance_json(measurement.its.threads);
    provenance.merge_patch(measurement.its.build);
    provenance["openmp"]["environment"] =
        variables_with_prefixes(measurement.its.contender.command.environment, {"OMP_", "GOMP_", "KMP_"});
    provenance["binary_sha256"] = measurement.sources.hash();
    return provenance;
}

/// Null if no other took turns with it.
Json turns_json(const Measured& measured, int contenders, std::uint64_t seed) {
    if (contenders == 1 || (!measured.sliced && measured.runs.size() == 1)) {
        return nullptr;
    }
    std::vector<double> seconds;
    for (const ProcessEnd& run : measured.runs) {
        seconds.insert(seconds.end(), run.seconds.begin(), run.seconds.end());
    }
    return {{"contenders", contenders},
            {"seed", seed},
            {"seconds", seconds},
            {"seconds_alone", measured.seconds_alone}};
}

/// The mean of each over the runs; null where one of them has no finite number.
Json counters_json(const std::vector<StatedTime>& stated) {
    std::map<std::string, std::optional<double>> sums;
    for (const StatedTime& one : stated) {
        for (const auto& [name, value] : one.counters) {
            std::optional<double>& sum = sums.try_emplace(name, 0.0).first->second;
            sum = sum && value ? std::optional(*sum + *value) : std::nullopt;
        }
    }
    Json counters = Json::object();
    for (auto& [name, sum] : sums) {
        counters[name] = sum ? Json(*sum / static_cast<double>(stated.size())) : Json(nullptr);
    }
    return counters;
}

/// A time for each run: the one that the program says, or the one from outside.
Json repetitions_json(const ProcessMeasurement& measurement) {
    Json repetitions = Json::array();
    for (std::size_t k = 0; k < measurement.measured.runs.size(); ++k) {
        const ProcessEnd& end = measurement.measured.runs[k];
        const bool says = !measurement.stated.empty();
        repetitions.push_back({{"steps_seconds", says ? measurement.stated[k].seconds : end.wall_seconds()},
                               {"cpu_seconds", says ? measurement.stated[k].cpu_seconds : end.cpu_seconds()},
                               {"waited_seconds", says ? Json(nullptr) : Json(or_null(end.waited_seconds))}});
    }
    return repetitions;
}

/// The mean of each over the runs that have it.
Json counted_json(const std::vector<ProcessEnd>& runs) {
    std::map<std::string, std::vector<double>> amounts;
    for (const ProcessEnd& run : runs) {
        for (const auto& [name, amount] : run.counted) {
            amounts[name].push_back(amount);
        }
    }
    Json counted = Json::object();
    for (const auto& [name, all] : amounts) {
        counted[name] = std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
    }
    return counted;
}

/// Of the last run; what adds up is that of all runs, and memory that of the largest.
Json ends_json(const Measured& measured) {
    const ProcessEnd& last = measured.runs.back();
    const ProcessEnd& largest = std::ranges::max(measured.runs, {}, &ProcessEnd::peak_memory_bytes);
    Json exit_codes = Json::array();
    for (const ProcessEnd& run : measured.runs) {
        exit_codes.push_back(run.exit_code);
    }
    const auto sum = [&measured](auto value) {
        double all = 0;
        for (const ProcessEnd& run : measured.runs) {
            all += std::invoke(value, run);
        }
        return all;
    };
    return {{"exit_code", last.exit_code},
            {"exit_codes", exit_codes},
            {"wall_seconds", sum(&ProcessEnd::wall_seconds)},
            {"user_seconds", sum(&ProcessEnd::user_seconds)},
            {"system_seconds", sum(&ProcessEnd::system_seconds)},
            {"runs", measured.runs.size()},
            {"peak_memory_bytes", or_null(largest.peak_memory_bytes)},
            {"peak_memory_reason", largest.memory_of},
            {"output_bytes", last.output.bytes + last.error.bytes},
            {"output_end", last.output.end},
            {"error_end", last_line(last.error.end)},
            {"seconds_left_behind", sum(&ProcessEnd::seconds_left_behind)},
            {"tree", last.kept_by},
            {"ran_on", last.ran_on},
            {"counted", counted_json(measured.runs)},
            {"undisturbed", text_or_null(measured.undisturbed)}};
}

} // namespace

Json process_json(const ProcessMeasurement& measurement, const Json& scene, int contenders,
                  std::uint64_t seed) {
    const DescribedProcess& its = measurement.its;
    const bool says = !measurement.stated.empty();
    Json process{{"command", its.contender.command.words},
                 {"folder", its.contender.command.folder},
                 {"sources", measurement.sources.json()},
                 {"changed", measurement.sources.changed()},
                 {"time_from", says ? "the program" : "outside"},
                 {"counters", counters_json(measurement.stated)},
                 {"library_version", says ? or_null(measurement.stated.back().library_version) : nullptr}};
    process.update(ends_json(measurement.measured));
    return record_of("process", its.tags,
                     {{"axes", its.axes},
                      {"scene", scene},
                      {"warm_ups", its.contender.warm_ups},
                      {"repetitions", repetitions_json(measurement)},
                      {"process_seconds", process["wall_seconds"]},
                      {"process", process},
                      {"turns", turns_json(measurement.measured, contenders, seed)},
                      {"check",
                       {{"verdict", its.checked.empty() ? "unchecked" : "passed"},
                        {"scope", its.checked.empty() ? "nothing" : its.checked},
                        {"reason", nullptr}}},
                      {"provenance", provenance_of(measurement)}});
}

Json failure_json(const ProcessMeasurement& measurement, const std::string& reason) {
    return {{"schema_version", 1},
            {"kind", "failure"},
            {"tags", tags_json(measurement.its.tags)},
            {"axes", measurement.its.axes},
            {"command", measurement.its.contender.command.words},
            {"exit_code", measurement.exit_code},
            {"reason", reason},
            {"recorded_at", utc_now()}};
}

} // namespace carom
