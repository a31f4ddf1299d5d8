#pragma once

#include <nlohmann/json.hpp>

#include "kernels/policies.hpp"
#include "variants/name.hpp"

namespace carom {

/// Every policy as a field of its own; null where it has no meaning for the variant. Of the engine without
/// steps `impact` is its name.
inline nlohmann::ordered_json policies_json(const Policies& policies, Engine engine) {
    if (engine == Engine::event_driven) {
        nlohmann::ordered_json json = policies_json(Policies{}, Engine::steps);
        for (auto& choice : json) {
            choice = nullptr;
        }
        json["impact"] = word(engine);
        json["precision"] = word(policies.precision);
        return json;
    }
    nlohmann::ordered_json json{{"neighbourhood", word(policies.neighbourhood)},
                                {"order", word(policies.order)},
                                {"self_contained", word(policies.self_contained)},
                                {"direction", nullptr},
                                {"find_schedule", word(policies.find_schedule)},
                                {"resolve_schedule", nullptr},
                                {"storage", word(policies.storage)},
                                {"prefetch", nullptr},
                                {"box_side", word(policies.box_side)},
                                {"overlaps", word(policies.overlaps)},
                                {"search", word(policies.search)},
                                {"worklist", word(policies.worklist)},
                                {"impact", word(policies.impact)},
                                {"precision", word(policies.precision)}};
    if (policies.storage == Storage::numbered) {
        json["prefetch"] = word(policies.prefetch);
    }
    if (policies.overlaps == Overlaps::lists) {
        json["direction"] = word(policies.direction);
    }
    if (!is_sequential(policies.order)) {
        json["resolve_schedule"] = word(policies.resolve_schedule);
    }
    return json;
}

} // namespace carom
