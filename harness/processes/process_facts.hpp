#pragma once

#include <nlohmann/json.hpp>

namespace carom {

/// How a program ended with all that it had started, and what that took: the facts as `carom processes` tells
/// them (experiments/side_by_side/run_result.py says what each of them means), of a run of which nothing is
/// known yet.
inline nlohmann::ordered_json no_facts() {
    return {{"seconds", nlohmann::ordered_json::array()},
            {"not_started", ""},
            {"unknown", ""},
            {"suspended", ""},
            {"exit_code", 0},
            {"signal", 0},
            {"out_of_time", false},
            {"went_on", ""},
            {"seconds_left_behind", 0.0},
            {"user_seconds", 0.0},
            {"system_seconds", 0.0},
            {"waited_seconds", nullptr},
            {"peak_memory_bytes", nullptr},
            {"memory_of", ""},
            {"counted", nlohmann::ordered_json::object()},
            {"output_bytes", 0},
            {"error_bytes", 0},
            {"output_end", ""},
            {"error_end", ""}};
}

/// Whether it is known to have ended by itself, with exit code 0.
inline bool succeeded(const nlohmann::ordered_json& facts) {
    return facts["not_started"] == "" && facts["unknown"] == "" && !facts["out_of_time"].get<bool>() &&
           facts["signal"] == 0 && facts["exit_code"] == 0;
}

} // namespace carom
