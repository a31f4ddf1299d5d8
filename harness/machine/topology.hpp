#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace carom {

/// Caches of one kind.
struct CacheLevel {
    std::string name;       ///< L1d, L1i, L2, L3
    std::int64_t bytes = 0; ///< of one of them
    int count = 0;
    int hardware_threads = 0; ///< that share one
};

/// The machine's shape, as far as it could be found out.
struct Topology {
    std::string source; ///< who tells: hwloc, or the operating system
    std::optional<int> packages = {};
    std::optional<int> cores = {};
    int hardware_threads = 1;
    std::optional<int> numa_nodes = {};
    std::vector<CacheLevel> caches = {}; ///< from the first level on; empty if nobody tells

    /// Has a core several hardware threads? Empty if nobody tells.
    std::optional<bool> smt() const {
        return cores ? std::optional(hardware_threads > *cores) : std::nullopt;
    }
};

/// Asks hwloc where the program is built with it, and the operating system where not.
Topology read_topology();

} // namespace carom
