#pragma once

#include <map>
#include <optional>
#include <string>

namespace carom {

/// A time that a program says of itself.
struct StatedTime {
    double seconds = 0;
    double cpu_seconds = 0; ///< 0 where it does not say
    /// Of a Google Benchmark, the mean over the repetitions; empty where one of them has no finite number.
    std::map<std::string, std::optional<double>> counters;
    std::optional<std::string> library_version; ///< of Google Benchmark, where it says one
    int threads = 1;                            ///< of the case of a Google Benchmark
};

/// Throws InputError if it is no regular expression (ECMAScript) with one group.
void require_pattern(const std::string& pattern);

/// The time in the one group of a regular expression (ECMAScript), at the one place of a program's output
/// that it matches: a number, and in the group or directly behind it a unit from ns to hours; or hours,
/// minutes and seconds in a row, as in 1m2.5s. The number may have a decimal comma, or groups of three digits
/// by commas or points. Without a unit it is in units of `unit_seconds`. Throws InputError if the expression
/// matches at no place or several, has not one group, takes a part of a longer number or time, or what stands
/// there is ambiguous, no positive number, or without any unit.
StatedTime time_in_output(const std::string& output, const std::string& pattern,
                          std::optional<double> unit_seconds = std::nullopt);

/// What Google Benchmark's JSON says of the case of that name: time and CPU time of an iteration, the mean
/// over its repetitions, and its counters. Where the report has only aggregates, their mean is taken. Throws
/// InputError, in one line that says what stands there, if it is no such report, has no such case or several
/// (two registrations of one name among them), or the case failed, was skipped or has no positive time.
StatedTime time_of_benchmark(const std::string& json, const std::string& name);

/// Why two times of Google Benchmarks cannot be compared, in one line; nothing if they can. Up to 1.8.5 the
/// library divides `real_time` by the number of threads, from 1.9.1 on it does not (its pull request 1836).
/// Of a case on several threads two unlike versions mean the same only where both are known to stand on one
/// side.
std::optional<std::string> unlike_times(const StatedTime& one, const StatedTime& other);

} // namespace carom
