#include "harness/records/record.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <utility>

#include "harness/machine/other_build.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/records/policies_json.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/json.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/support/text.hpp"
#include "harness/verify/checker.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

Json axes_json(const Variant& variant, const Tuning& tuning) {
    Json axes{{"variant", variant.name}};
    axes.update(policies_json(variant.policies, variant.engine));
    const bool has_loops = variant.engine == Engine::steps;
    const bool find_has_chunk = has_loops && has_chunk(variant.policies.find_schedule);
    const bool resolve_has_chunk =
        has_loops && !is_sequential(variant.policies.order) && has_chunk(variant.policies.resolve_schedule);
    axes["find_chunk"] = find_has_chunk ? Json(tuning.find_chunk) : Json(nullptr);
    axes["resolve_chunk"] = resolve_has_chunk ? Json(tuning.resolve_chunk) : Json(nullptr);
    axes["threads"] = tuning.threads;
    axes["substeps"] = tuning.substeps;
    axes["tolerance"] = tuning.tolerance == Tolerance::relative ? "relative" : "published";
    return axes;
}

Json work_json(const Measurement& measurement, const Tally& work) {
    return {{"steps", std::int64_t{measurement.scene.steps} * measurement.tuning.substeps},
            {"overlaps", work.overlaps},
            {"pair_resolves", work.pair_resolves},
            {"wall_resolves", work.wall_resolves},
            {"pair_attempts", work.pair_attempts},
            {"sweeps", work.sweeps}};
}

Json errors_json(const Measurement& measurement, const Run& last) {
    const Scene& scene = measurement.scene;
    const Checker checker(scene.side, scene.radius, 1.0 / measurement.tuning.substeps,
                          measurement.tuning.tolerance, rounding_of(measurement.variant.policies),
                          measurement.variant.policies.impact);
    return {{"energy_drift", number_or_null(energy_drift(scene, last.discs))},
            {"discs_outside", discs_outside(scene, last.discs)},
            {"unresolved_pairs", checker.count_colliding(last.discs)}};
}

/// Now, in UTC, as ISO 8601 says it.
std::string utc_now() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm parts{};
    gmtime_r(&now, &parts);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text.data();
}

} // namespace

const char* word(CheckScope scope) { return scope == CheckScope::every_step ? "every-step" : "last-step"; }

Json tags_json(const std::vector<std::string>& tags) {
    Json object = Json::object();
    for (const std::string& tag : tags) {
        const auto equals = tag.find('=');
        if (equals == std::string::npos || equals == 0) {
            throw InputError("--tag: found '" + tag + "', expected KEY=VALUE");
        }
        const std::string value = tag.substr(equals + 1);
        const auto number = Json::parse(value, nullptr, false);
        object[tag.substr(0, equals)] = number.is_number() ? number : Json(value);
    }
    return object;
}

Json scene_json(const Scene& scene, const std::string& name, const std::string& sha256) {
    return {{"name", name},
            {"sha256", sha256},
            {"particles", scene.discs.size()},
            {"side", scene.side},
            {"radius", scene.radius},
            {"steps", scene.steps},
            {"area_fraction", area_fraction(scene)}};
}

Json turns_json(const TurnsPlan& plan, const std::vector<std::vector<TurnTime>>& turns) {
    std::vector<std::pair<std::size_t, const TurnTime*>> in_order;
    for (std::size_t contender = 0; contender < turns.size(); ++contender) {
        for (const TurnTime& turn : turns[contender]) {
            in_order.emplace_back(contender, &turn);
        }
    }
    std::ranges::sort(in_order, {}, [](const auto& one) { return one.second->place; });
    Json json{{"seed", plan.seed},      {"rounds", plan.rounds},    {"contenders", Json::array()},
              {"steps", Json::array()}, {"seconds", Json::array()}, {"returning_seconds", Json::array()}};
    for (const auto& [contender, turn] : in_order) {
        json["contenders"].push_back(contender);
        json["steps"].push_back(turn->steps);
        json["seconds"].push_back(turn->seconds);
        json["returning_seconds"].push_back(or_null(turn->returning_seconds));
    }
    return json;
}

Json contender_json(const Measurement& measurement) {
    const Run& last = measurement.repetitions.back();
    Json repetitions = Json::array();
    if (!measurement.violation) {
        for (const Run& run : measurement.repetitions) {
            repetitions.push_back({{"steps_seconds", run.steps_seconds}, {"cpu_seconds", run.cpu_seconds}});
        }
    }
    Json json{{"tags", tags_json(measurement.tags)},
              {"axes", axes_json(measurement.variant, measurement.tuning)},
              {"scene", scene_json(measurement.scene, measurement.scene_name, measurement.scene_sha256)},
              {"warm_ups", measurement.warm_ups},
              {"repetitions", repetitions},
              {"parse_seconds", measurement.parse_seconds},
              {"process_seconds", measurement.own_seconds.value_or(process_seconds())},
              {"work", work_json(measurement, last.work)},
              {"errors", errors_json(measurement, last)},
              {"check",
               {{"verdict", measurement.violation ? "failed" : "passed"},
                {"scope", word(measurement.scope)},
                {"reason", or_null(measurement.violation)}}},
              {"state_hash", state_hash(last.discs)}};
    if (!measurement.library.empty()) {
        json["provenance"] = provenance_of_build(measurement.library);
    }
    return json;
}

void write_record(const std::string& path, const char* kind, const Json& contenders, int threads,
                  const Json& turns) {
    OutputFile file(path);
    const Json record{{"schema_version", 2},      {"kind", kind},   {"recorded_at", utc_now()},
                      {"contenders", contenders}, {"turns", turns}, {"provenance", provenance_json(threads)}};
    file.write(json_text(record, 1) + "\n");
    file.finish();
}

} // namespace carom
