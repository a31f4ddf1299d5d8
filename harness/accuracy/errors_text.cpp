#include "harness/accuracy/errors_text.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace carom {
namespace {

/// How a measure stands on a terminal.
struct ShownError {
    const char* key;
    const char* what;
    const char* unit;
};

constexpr std::array shown_errors{
    ShownError{"momentum_drift", "momentum that no wall explains", " of the sum of |v|"},
    ShownError{"penetration_worst", "worst penetration", " r"},
    ShownError{"penetration_mean", "mean penetration", " r"},
    ShownError{"unresolved_pairs", "left colliding", ""},
    ShownError{"collision_rate", "collisions", " a disc and unit of time"},
    ShownError{"collision_rate_reference", "  of the reference", ""},
    ShownError{"pressure", "pressure", ""},
    ShownError{"pressure_reference", "  of the reference", ""},
    ShownError{"speed_distance", "distance of the speeds", " (Kolmogorov-Smirnov)"},
    ShownError{"time_to_tenth_radius", "0.1 r from the reference after", " units of time"}};

} // namespace

void print_errors(const nlohmann::ordered_json& errors) {
    for (const auto& [key, what, unit] : shown_errors) {
        const auto& value = errors[key];
        if (value.is_number() && std::isfinite(value.get<double>())) {
            std::printf("  %-33s %12.6g%s\n", what, value.get<double>(), unit);
        } else {
            std::printf("  %-33s    not known\n", what);
        }
    }
    for (const auto& at : errors["trajectory"]) {
        std::printf("  distance after %6d units of time %13.6g r (root mean square)\n", at["time"].get<int>(),
                    at["rms_distance"].is_null() ? std::nan("") : at["rms_distance"].get<double>());
    }
    for (const char* reason : {"pressure_reason", "reference_reason"}) {
        if (!errors[reason].is_null()) {
            std::printf("  %s\n", errors[reason].get<std::string>().c_str());
        }
    }
}

} // namespace carom
