#pragma once

#include <string>
#include <vector>

namespace carom {

/// Hands the --benchmark_* flags to Google Benchmark. Throws InputError for a flag, or a value of one, that
/// it does not take: by itself it prints how it is used and ends the process, as if all were well.
void initialize_google_benchmark(const std::vector<std::string>& flags);

/// Runs all registered cases that the filter lets through. What Google Benchmark says on standard error is
/// passed on, except that it was built as DEBUG, which is explained. Throws InputError if no case is let
/// through; `flags` are those of the initialization, and `example` is the name of a case.
void run_google_benchmark(const std::vector<std::string>& flags, const std::string& example);

} // namespace carom
