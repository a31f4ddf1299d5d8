// The topology where the program is built with hwloc.

#include <optional>
#include <utility>

#include <hwloc.h>

#include "harness/machine/topology.hpp"
#include "harness/support/silence.hpp"

namespace carom {

Topology read_topology() {
    const Silence silence; // it warns of what a virtual machine's system tells wrongly
    Topology topology{.source = "hwloc"};
    hwloc_topology_t machine = nullptr;
    if (hwloc_topology_init(&machine) != 0) {
        return topology;
    }
    hwloc_topology_set_icache_types_filter(machine, HWLOC_TYPE_FILTER_KEEP_ALL);
    if (hwloc_topology_load(machine) == 0) {
        const auto count = [machine](hwloc_obj_type_t type) {
            const int objects = hwloc_get_nbobjs_by_type(machine, type);
            return objects > 0 ? std::optional(objects) : std::nullopt;
        };
        topology.packages = count(HWLOC_OBJ_PACKAGE);
        topology.cores = count(HWLOC_OBJ_CORE);
        topology.hardware_threads = count(HWLOC_OBJ_PU).value_or(1);
        topology.numa_nodes = count(HWLOC_OBJ_NUMANODE);
        for (const auto& [name, type] : {std::pair{"L1d", HWLOC_OBJ_L1CACHE},
                                         {"L1i", HWLOC_OBJ_L1ICACHE},
                                         {"L2", HWLOC_OBJ_L2CACHE},
                                         {"L3", HWLOC_OBJ_L3CACHE},
                                         {"L4", HWLOC_OBJ_L4CACHE}}) {
            if (const auto caches = count(type)) {
                const hwloc_obj_t first = hwloc_get_obj_by_type(machine, type, 0);
                topology.caches.push_back({.name = name,
                                           .bytes = static_cast<std::int64_t>(first->attr->cache.size),
                                           .count = *caches,
                                           .hardware_threads = hwloc_bitmap_weight(first->cpuset)});
            }
        }
    }
    hwloc_topology_destroy(machine);
    return topology;
}

} // namespace carom
