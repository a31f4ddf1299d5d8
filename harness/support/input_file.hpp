#pragma once

#include <filesystem>
#include <string>

namespace carom {

/// Whether the path is "-", which stands for standard input.
bool is_standard_input(const std::filesystem::path& path);

/// The path as a message names it: "standard input" for "-".
std::string shown_name(const std::filesystem::path& path);

/// The bytes of a file, or of standard input for "-". Throws InputError if it cannot be read.
std::string read_file(const std::filesystem::path& path);

} // namespace carom
