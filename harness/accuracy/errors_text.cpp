#include "harness/accuracy/errors_text.hpp"

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

namespace carom {

void print_errors(const ErrorMeasures& errors) {
    const auto line = [](const char* what, std::optional<double> value, const char* unit) {
        if (value && std::isfinite(*value)) {
            std::printf("  %-33s %12.6g%s%s\n", what, *value, *unit != '\0' ? " " : "", unit);
        } else {
            std::printf("  %-33s    not known\n", what);
        }
    };
    const auto of_reference = [&errors](auto AgainstReference::* field) -> std::optional<double> {
        return errors.reference ? std::optional<double>((*errors.reference).*field) : std::nullopt;
    };
    line("momentum that no wall explains", errors.momentum_drift, "of the sum of |v|");
    line("worst penetration", errors.penetration_worst, "r");
    line("mean penetration", errors.penetration_mean, "r");
    line("left colliding", static_cast<double>(errors.unresolved_pairs), "");
    line("collisions", errors.collision_rate, "a disc and unit of time");
    line("  of the reference", of_reference(&AgainstReference::collision_rate), "");
    line("pressure", errors.pressure, "");
    line("  of the reference", of_reference(&AgainstReference::pressure), "");
    line("distance of the speeds", of_reference(&AgainstReference::speed_distance), "(Kolmogorov-Smirnov)");
    const bool leaves = errors.reference && errors.reference->time_to_tenth_radius;
    line("0.1 r from the reference after",
         leaves ? std::optional<double>(*errors.reference->time_to_tenth_radius) : std::nullopt,
         "units of time");
    if (errors.reference) {
        for (const DistanceAt& at : errors.reference->trajectory) {
            std::printf("  distance after %6d units of time %13.6g r (root mean square)\n", at.time,
                        at.rms_distance);
        }
    }
    for (const std::string& reason : {errors.pressure_reason, errors.reference_reason}) {
        if (!reason.empty()) {
            std::printf("  %s\n", reason.c_str());
        }
    }
}

} // namespace carom
