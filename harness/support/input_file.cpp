#include "harness/support/input_file.hpp"

#include <array>
#include <cerrno>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/support/errors.hpp"

namespace carom {
namespace {

/// Calls `read_some` until it is no longer interrupted by a signal.
template <class Read> ssize_t uninterrupted(const Read& read_some) {
    ssize_t count = 0;
    do {
        count = read_some();
    } while (count < 0 && errno == EINTR);
    return count;
}

} // namespace

InputFile::InputFile(const std::filesystem::path& path)
    : path_(path.string()), descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    struct stat status{};
    if (descriptor_ < 0 || fstat(descriptor_, &status) != 0 || S_ISDIR(status.st_mode)) {
        if (descriptor_ >= 0) {
            close(descriptor_);
        }
        throw InputError(path_ + ": cannot be read, expected a readable file");
    }
    size_ = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0;
}

InputFile::~InputFile() { close(descriptor_); }

std::string_view InputFile::piece(std::size_t offset, std::span<char> buffer) const {
    std::size_t filled = 0;
    while (filled < buffer.size()) {
        const ssize_t count = uninterrupted([&] {
            return pread(descriptor_, buffer.data() + filled, buffer.size() - filled,
                         static_cast<off_t>(offset + filled));
        });
        if (count <= 0) {
            break;
        }
        filled += static_cast<std::size_t>(count);
    }
    return {buffer.data(), filled};
}

std::string InputFile::whole() const {
    std::string text;
    text.reserve(size_);
    std::array<char, 1 << 16> buffer;
    ssize_t count = 0;
    while ((count = uninterrupted([&] { return read(descriptor_, buffer.data(), buffer.size()); })) > 0) {
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    if (count < 0) {
        throw InputError(path_ + ": reading broke off, expected a readable file");
    }
    return text;
}

std::string read_file(const std::filesystem::path& path) { return InputFile(path).whole(); }

} // namespace carom
