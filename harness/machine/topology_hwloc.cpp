// The topology where the program is built with hwloc.

#include <array>
#include <utility>

#include <hwloc.h>

#include "harness/machine/topology.hpp"
#include "harness/support/silence.hpp"

namespace carom {
namespace {

/// hwloc's view of this machine, given back when this is gone.
class Hwloc {
  public:
    Hwloc() {
        if (hwloc_topology_init(&topology_) == 0) {
            hwloc_topology_set_icache_types_filter(topology_, HWLOC_TYPE_FILTER_KEEP_ALL);
            loaded_ = hwloc_topology_load(topology_) == 0;
        }
    }
    ~Hwloc() {
        if (topology_ != nullptr) {
            hwloc_topology_destroy(topology_);
        }
    }
    Hwloc(const Hwloc&) = delete;
    Hwloc& operator=(const Hwloc&) = delete;

    /// How many objects of the type there are; empty if hwloc cannot tell.
    std::optional<int> count(hwloc_obj_type_t type) const {
        const int objects = loaded_ ? hwloc_get_nbobjs_by_type(topology_, type) : 0;
        return objects > 0 ? std::optional(objects) : std::nullopt;
    }

    std::optional<CacheLevel> cache(const std::string& name, hwloc_obj_type_t type) const {
        const auto objects = count(type);
        if (!objects) {
            return std::nullopt;
        }
        const hwloc_obj_t first = hwloc_get_obj_by_type(topology_, type, 0);
        return CacheLevel{.name = name,
                          .bytes = static_cast<std::int64_t>(first->attr->cache.size),
                          .count = *objects,
                          .hardware_threads = hwloc_bitmap_weight(first->cpuset)};
    }

  private:
    hwloc_topology_t topology_ = nullptr;
    bool loaded_ = false;
};

} // namespace

Topology read_topology() {
    const Silence silence; // it warns of what a virtual machine's system tells wrongly
    const Hwloc hwloc;
    Topology topology{.source = "hwloc",
                      .packages = hwloc.count(HWLOC_OBJ_PACKAGE),
                      .cores = hwloc.count(HWLOC_OBJ_CORE),
                      .hardware_threads = hwloc.count(HWLOC_OBJ_PU).value_or(1),
                      .numa_nodes = hwloc.count(HWLOC_OBJ_NUMANODE)};
    const std::array<std::pair<const char*, hwloc_obj_type_t>, 5> caches{{{"L1d", HWLOC_OBJ_L1CACHE},
                                                                          {"L1i", HWLOC_OBJ_L1ICACHE},
                                                                          {"L2", HWLOC_OBJ_L2CACHE},
                                                                          {"L3", HWLOC_OBJ_L3CACHE},
                                                                          {"L4", HWLOC_OBJ_L4CACHE}}};
    for (const auto& [name, type] : caches) {
        if (const auto cache = hwloc.cache(name, type)) {
            topology.caches.push_back(*cache);
        }
    }
    return topology;
}

} // namespace carom
