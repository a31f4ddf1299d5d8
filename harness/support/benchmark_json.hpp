#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace carom {

/// The report that Google Benchmark wrote as JSON: an object whose `benchmarks` is a list of objects.
///
/// It writes more than JSON has: NaN, Infinity and -Infinity bare, control characters and bytes that are no
/// UTF-8 as they came. Such a number is read as `not_finite` wants it, the others as JSON has them. Of two
/// fields of one name in an object the first is taken, since a counter may have the name of a field of the
/// report, and counters come last.
///
/// Throws InputError, in one line that says what stands there instead.
nlohmann::json read_benchmark_json(const std::string& text);

/// The word of a number that is none, such as NaN; empty for any other value.
std::string not_finite(const nlohmann::json& value);

} // namespace carom
