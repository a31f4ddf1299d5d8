#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace carom {

/// Whether the path is "-", which stands for standard input.
bool is_standard_input(const std::filesystem::path& path);

/// The path as a message names it: "standard input" for "-".
std::string shown_name(const std::filesystem::path& path);

/// A file, read whole or by several threads piece by piece; "-" is standard input.
class InputFile {
  public:
    /// Throws InputError if it cannot be opened for reading.
    explicit InputFile(const std::filesystem::path& path);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    /// In bytes; of standard input and what is no plain file, such as a pipe, 0.
    std::size_t size() const { return size_; }

    /// The bytes from `offset` on, as many as `buffer` holds, in it: fewer at the end of the file, where
    /// reading breaks off, and of what is no plain file. Any number of threads may ask at once.
    std::string_view piece(std::size_t offset, std::span<char> buffer) const;

    /// All bytes. Throws InputError if reading breaks off. Once only, if `size` is 0.
    std::string whole() const;

  private:
    std::string path_;
    int descriptor_;
    std::size_t size_ = 0;
};

/// The bytes of a file. Throws InputError if it cannot be read.
std::string read_file(const std::filesystem::path& path);

} // namespace carom
