#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "harness/machine/noise.hpp"

namespace carom {

/// What this machine can and cannot measure, and why, as one object; null is what is not known. Looks at the
/// machine, and for so many seconds at its noise. Nothing of it is changed.
nlohmann::ordered_json examine_machine(double noise_seconds);

/// The same for a reader: lines of at most 80 columns.
std::string doctor_text(const nlohmann::ordered_json& findings);

/// How much neighbouring stretches of time differ, by their length, as lines with a bar each.
std::string noise_figure(const Noise& noise);

} // namespace carom
