// The topology where the program is built without hwloc.

#include "harness/machine/machine.hpp"
#include "harness/machine/topology.hpp"

namespace carom {

Topology read_topology() {
    const auto machine = read_machine();
    return {.source = "the operating system",
            .cores = machine["cores"].is_null() ? std::nullopt : std::optional(machine["cores"].get<int>()),
            .hardware_threads = machine["hardware_threads"]};
}

} // namespace carom
