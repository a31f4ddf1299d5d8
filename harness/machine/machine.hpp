#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace carom {

/// What the operating system tells of the machine now, without any right or library, as the record schema's
/// `provenance` names it; null is what it does not tell. `affinity` are the CPUs that this process may run
/// on, as 0-3,8; `virtualised` is whether the CPU shows the hypervisor flag.
nlohmann::ordered_json read_machine();

/// The first line of a file of the system, or nothing if it cannot be read.
std::optional<std::string> first_line(const std::string& path);

} // namespace carom
