#pragma once

#include <string>
#include <vector>

#include "harness/support/environment.hpp"

namespace carom {

/// A program to be run as it is: no shell sees its words.
struct ProcessCommand {
    std::vector<std::string> words; ///< the program, with a slash or to be found on PATH; its arguments
    std::string folder = {};        ///< that it runs in; empty: this process's own
    std::vector<std::string> environment = own_environment(); ///< NAME=VALUE, all that it sees
    double most_seconds = 600;        ///< of its own running time; what takes longer is killed
    double most_seconds_behind = 1e9; ///< that what it started may go on after its own end
    std::string output_file = {};     ///< that its standard output goes into as well; may be empty
};

} // namespace carom
