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

std::string read_file(const std::filesystem::path& path) {
    const std::string name = shown_name(path);
    const int file = open_to_read(path);
    if (file < 0) {
        refuse(name, "cannot be read", errno);
    }
    struct stat status{};
    std::string text;
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
        text.reserve(static_cast<std::size_t>(status.st_size));
    }
    std::array<char, 1 << 16> buffer;
    ssize_t count = 0;
    while ((count = uninterrupted([&] { return read(file, buffer.data(), buffer.size()); })) > 0) {
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    const int error = errno;
    close(file);
    if (count < 0) {
        refuse(name, error == EISDIR ? "cannot be read" : "reading broke off", error);
    }
    return text;
}

} // namespace carom
