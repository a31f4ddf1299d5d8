#pragma once

#include <nlohmann/json.hpp>

#include "kernels/policies.hpp"
#include "variants/name.hpp"

namespace carom {

/// Every policy as a field of its own; null where it has no meaning for the variant. Of the engine without
/// steps `impact` is its name.
inline nlohmann::ordered_json policies_json(const Policies& policies, Engine engine) {
    const bool has_steps = engine == Engine::steps;
    nlohmann::ordered_json json;
    for_each_policy([&](const char* policy, const char* /*prefix*/, auto axis) {
        json[policy] = has_steps ? nlohmann::ordered_json(word(policies.*axis)) : nullptr;
    });
    if (!has_steps) {
        json["impact"] = word(engine);
        json["precision"] = word(policies.precision);
    }
    if (policies.storage != Storage::numbered) {
        json["prefetch"] = nullptr;
    }
    if (policies.overlaps != Overlaps::lists) {
        json["direction"] = nullptr;
    }
    if (is_sequential(policies.order)) {
        json["resolve_schedule"] = nullptr;
    }
    return json;
}

} // namespace carom
