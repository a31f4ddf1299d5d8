#pragma once

#include <nlohmann/json.hpp>

namespace carom {

/// Prints every error measure (`error_measures_json`), a line each; what is not known says so.
void print_errors(const nlohmann::ordered_json& errors);

} // namespace carom
