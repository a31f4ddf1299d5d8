#pragma once

#include <filesystem>
#include <string_view>

namespace carom {

/// A file that takes its name only when complete: written under a temporary name beside it, flushed to the
/// disk and renamed by `finish`. Without `finish` nothing of it is left. A device or pipe of that name is
/// written to as it is. Every member but the destructor throws InputError if the system refuses.
class OutputFile {
  public:
    explicit OutputFile(std::filesystem::path path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view text);
    void finish();

  private:
    [[noreturn]] void refuse(const char* what) const;

    std::filesystem::path path_;
    std::filesystem::path temporary_; ///< empty for a device or pipe
    int descriptor_ = -1;
};

/// Whether the path is empty or "-", which stands for standard output where a text may go there.
bool is_standard_output(const std::filesystem::path& path);

/// Throws InputError if no file can be written there, if it is one: to be asked before the work whose result
/// it will hold.
void require_writable(const std::filesystem::path& path);

/// Writes a text to a file, or to standard output. Throws InputError.
void write_text(const std::filesystem::path& path, std::string_view text);

} // namespace carom
