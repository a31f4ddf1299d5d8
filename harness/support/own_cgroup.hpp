#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace carom {

/// The path of this process's control group of version 2, as proc/self/cgroup below `root` tells; empty if it
/// is in none.
inline std::optional<std::filesystem::path> own_cgroup(const std::filesystem::path& root) {
    std::ifstream file(root / "proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("0::")) {
            return line.substr(3);
        }
    }
    return std::nullopt;
}

} // namespace carom
