#pragma once

#include "harness/accuracy/error_measures.hpp"

namespace carom {

/// Prints every error measure, a line each; what is not known says so.
void print_errors(const ErrorMeasures& errors);

} // namespace carom
