#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "harness/support/temporary_folder.hpp"

namespace carom::tests {

/// A directory of its own for one test, removed with all that is in it.
class TemporaryDirectory : public TemporaryFolder {
  public:
    TemporaryDirectory() : TemporaryFolder("carom-test-") {}

    /// Writes a file and returns its path.
    std::string write(const std::string& name, std::string_view text) const {
        std::ofstream(path() / name, std::ios::binary) << text;
        return *this / name;
    }

    bool empty() const { return std::filesystem::is_empty(path()); }
};

inline std::string content_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace carom::tests
