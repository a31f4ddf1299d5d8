#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace carom::tests {

/// How a run of the program ended, and what it printed.
struct ProgramResult {
    int exit_code = -1; ///< minus the signal's number if a signal ended it
    std::string output;
    std::string error; ///< standard error without the notes
    std::string notes; ///< of standard error, the lines that tell of the machine and not of the run
};

/// Runs the built program to its end. `environment` holds settings NAME=VALUE on top of this process's own,
/// and NAME for one that is to be missing; a `standard_output` other than "" is the file that it writes to.
ProgramResult run_carom(std::vector<std::string> arguments, const std::vector<std::string>& environment = {},
                        const std::string& standard_output = "",
                        const std::string& standard_input = "/dev/null");

/// Did the program refuse as promised: exit code, nothing on standard output, one line on standard error that
/// holds every one of `parts`?
testing::AssertionResult refused(const ProgramResult& result, int exit_code,
                                 const std::vector<std::string>& parts);

} // namespace carom::tests
