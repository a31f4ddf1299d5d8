#pragma once

#include <string>
#include <vector>

#include "harness/records/process_json.hpp"

namespace carom {

/// Those that the file of `carom processes` describes. Throws InputError, which names the process and the
/// key, before anything runs.
std::vector<DescribedProcess> read_processes(const std::string& path);

} // namespace carom
