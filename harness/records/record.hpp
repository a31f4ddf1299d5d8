#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/measure/measure.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"
#include "variants/registry.hpp"

namespace carom {

/// What of a measured process goes into its record (record.schema.json).
struct Measurement {
    const Scene& scene;
    std::string scene_name;   ///< file name, without folders
    std::string scene_sha256; ///< of the file's bytes
    const Variant& variant;
    Tuning tuning;
    CheckScope scope = CheckScope::last_step;
    int warm_ups = 0;
    double parse_seconds = 0;
    std::vector<std::string> tags;        ///< KEY=VALUE
    std::vector<Run> repetitions;         ///< all of them, in the order they ran
    std::optional<std::string> violation; ///< of the first run that failed its check
};

/// The record of a process, of kind "bench", without a profile. Where the check failed it holds no times.
nlohmann::ordered_json record_json(const Measurement& measurement);

/// Writes a record under a temporary name, flushes and renames it. Throws InputError.
void write_record(const std::string& path, const nlohmann::ordered_json& record);

/// Tags as an object: a value that is a JSON number becomes one, any other is text. Throws InputError.
nlohmann::ordered_json tags_json(const std::vector<std::string>& tags);

/// What a record says of a scene and of its file: the name without folders, and the hash of its bytes.
nlohmann::ordered_json scene_json(const Scene& scene, const std::string& name, const std::string& sha256);

/// A number, or null where there is none or it is not finite.
nlohmann::ordered_json number_or_null(const std::optional<double>& value);

/// Now, in UTC, as ISO 8601 says it.
std::string utc_now();

/// The words of the record for a scope: "last-step" or "every-step".
const char* word(CheckScope scope);

} // namespace carom
