#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace carom {

/// The control groups of version 2 that this process is in, from its own to the topmost, as proc/self/cgroup
/// below `root` tells and where systemd mounts them, alone or beside those of version 1. None if it is in
/// none. A container may be told a name that it does not see; the top is what it does see.
inline std::vector<std::filesystem::path> own_cgroups(const std::filesystem::path& root = "/") {
    const std::filesystem::path place = root / "sys/fs/cgroup";
    const auto top = std::filesystem::exists(place / "unified") ? place / "unified" : place;
    std::vector<std::filesystem::path> groups;
    std::ifstream file(root / "proc/self/cgroup");
    for (std::string line; groups.empty() && std::getline(file, line);) {
        if (line.starts_with("0::")) {
            auto own = std::filesystem::path(line.substr(3)).relative_path();
            for (; !own.empty(); own = own.parent_path()) {
                groups.push_back(top / own);
            }
            groups.push_back(top);
        }
    }
    return groups;
}

} // namespace carom
