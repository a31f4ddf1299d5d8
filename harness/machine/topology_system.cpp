// The topology where the program is built without hwloc.

#include "harness/machine/machine.hpp"
#include "harness/machine/topology.hpp"

namespace carom {

Topology read_topology() {
    const Machine machine = read_machine();
    return {.source = "the operating system",
            .cores = machine.cores,
            .hardware_threads = machine.hardware_threads};
}

} // namespace carom
