#include "harness/support/input_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>

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

int open_to_read(const std::filesystem::path& path) {
    return is_standard_input(path) ? fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                                   : open(path.c_str(), O_RDONLY | O_CLOEXEC);
}

[[noreturn]] void refuse(const std::string& path, const char* what, int error) {
    throw InputError((path.empty() ? "''" : path) + ": " + what + " (" + std::strerror(error) +
                     "), expected a readable file");
}

} // namespace

bool is_standard_input(const std::filesystem::path& path) { return path == "-"; }

std::string shown_name(const std::filesystem::path& path) {
    return is_standard_input(path) ? "standard input" : path.string();
}

InputFile::InputFile(const std::filesystem::path& path)
    : path_(shown_name(path)), descriptor_(open_to_read(path)) {
    if (descriptor_ < 0) {
        refuse(path_, "cannot be read", errno);
    }
    struct stat status{};
    int error = fstat(descriptor_, &status) == 0 ? 0 : errno;
    if (S_ISDIR(status.st_mode)) {
        error = EISDIR;
    }
    if (error != 0) {
        close(descriptor_);
        refuse(path_, "cannot be read", error);
    }
    // Some of standard input may have been read by somebody else: it has no beginning to go back to.
    const bool plain = S_ISREG(status.st_mode) && !is_standard_input(path);
    size_ = plain ? static_cast<std::size_t>(status.st_size) : 0;
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
        refuse(path_, "reading broke off", errno);
    }
    return text;
}

std::string read_file(const std::filesystem::path& path) { return InputFile(path).whole(); }

} // namespace carom
