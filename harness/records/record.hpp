#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/measure/measurement.hpp"
#include "harness/measure/turns.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// What a record says of a variant that was measured. Where the check failed it holds no times.
nlohmann::ordered_json contender_json(const Measurement& measurement);

/// All turns of a process in the order of time; `turns` has those of each contender.
nlohmann::ordered_json turns_json(const TurnsPlan& plan, const std::vector<std::vector<TurnTime>>& turns);

/// Writes a record of this kind, with its list of contenders, under a temporary name, flushes and renames it.
/// So many threads were asked for. Throws InputError.
void write_record(const std::string& path, const char* kind, const nlohmann::ordered_json& contenders,
                  int threads, const nlohmann::ordered_json& turns = nullptr);

/// Tags as an object: a value that is a JSON number becomes one, any other is text. Throws InputError.
nlohmann::ordered_json tags_json(const std::vector<std::string>& tags);

/// What a record says of a scene and of its file: the name without folders, and the hash of its bytes.
nlohmann::ordered_json scene_json(const Scene& scene, const std::string& name, const std::string& sha256);

/// The words of the record for a scope: "last-step" or "every-step".
const char* word(CheckScope scope);

} // namespace carom
