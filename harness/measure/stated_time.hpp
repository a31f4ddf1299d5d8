#pragma once

#include <map>
#include <string>

namespace carom {

/// A time that a program says of itself.
struct StatedTime {
    double seconds = 0;
    double cpu_seconds = 0;                 ///< 0 where it does not say
    std::map<std::string, double> counters; ///< of a Google Benchmark
};

/// Throws InputError if it is no regular expression (ECMAScript) with one group.
void require_pattern(const std::string& pattern);

/// The number in the one group of a regular expression (ECMAScript), in the one line of a program's output
/// that it matches, times `unit_seconds`. Throws InputError if it matches no line or several, has not one
/// group, or what stands there is no positive number.
StatedTime time_in_output(const std::string& output, const std::string& pattern, double unit_seconds);

/// What Google Benchmark's JSON says of the case of that name: time and CPU time of an iteration, the mean
/// over its repetitions, and its counters. Throws InputError if there is no such case, or several, or it
/// ended with an error.
StatedTime time_of_benchmark(const std::string& json, const std::string& name);

} // namespace carom
