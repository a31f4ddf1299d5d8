#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/measure/measurement.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// The record of a process, of kind "bench", without a profile. Where the check failed it holds no times.
nlohmann::ordered_json record_json(const Measurement& measurement);

/// A record of this kind: what every record begins with, the tags as `tags_json` has them, then these fields.
/// Throws InputError.
nlohmann::ordered_json record_of(const char* kind, const std::vector<std::string>& tags,
                                 const nlohmann::ordered_json& fields);

/// Writes a record under a temporary name, flushes and renames it. Throws InputError.
void write_record(const std::string& path, const nlohmann::ordered_json& record);

/// Tags as an object: a value that is a JSON number becomes one, any other is text. Throws InputError.
nlohmann::ordered_json tags_json(const std::vector<std::string>& tags);

/// What a record says of a scene and of its file: the name without folders, and the hash of its bytes.
nlohmann::ordered_json scene_json(const Scene& scene, const std::string& name, const std::string& sha256);

/// Now, in UTC, as ISO 8601 says it.
std::string utc_now();

/// The words of the record for a scope: "last-step" or "every-step".
const char* word(CheckScope scope);

} // namespace carom
