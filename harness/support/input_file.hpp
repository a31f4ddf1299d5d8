#pragma once

#include <filesystem>
#include <string>

namespace carom {

/// The bytes of a file. Throws InputError if it cannot be read.
std::string read_file(const std::filesystem::path& path);

} // namespace carom
