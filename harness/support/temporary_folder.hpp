#pragma once

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

#include "harness/support/errors.hpp"

namespace carom {

/// A folder for temporary files, gone with all that is in it when this is.
class TemporaryFolder {
  public:
    /// Its name begins with `prefix`. Throws InputError if it cannot be made.
    explicit TemporaryFolder(const std::string& prefix) {
        std::string name =
            (std::filesystem::temp_directory_path() / (prefix + "XXXXXX")).lexically_normal().string();
        if (mkdtemp(name.data()) == nullptr) {
            throw InputError(name + ": cannot be made (" + std::strerror(errno) +
                             "), expected a writable folder for temporary files (TMPDIR)");
        }
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    /// The path of a file in it; of itself for "".
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

} // namespace carom
