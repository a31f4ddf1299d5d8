#include "harness/support/input_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/support/errors.hpp"

namespace carom {

bool is_standard_input(const std::filesystem::path& path) { return path == "-"; }

std::string shown_name(const std::filesystem::path& path) {
    return is_standard_input(path) ? "standard input" : path.string();
}

std::string read_file(const std::filesystem::path& path) {
    const int file = is_standard_input(path) ? fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                                             : open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status{};
    std::string text;
    if (file >= 0 && fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
        text.reserve(static_cast<std::size_t>(status.st_size));
    }
    std::array<char, 1 << 16> buffer;
    ssize_t count = file >= 0 ? 1 : -1;
    while (file >= 0 &&
           ((count = read(file, buffer.data(), buffer.size())) > 0 || (count < 0 && errno == EINTR))) {
        text.append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
    const int error = errno;
    close(file);
    if (count < 0) {
        throw InputError((path.empty() ? "''" : shown_name(path)) + ": " +
                         (file < 0 || error == EISDIR ? "cannot be read" : "reading broke off") + " (" +
                         std::strerror(error) + "), expected a readable file");
    }
    return text;
}

} // namespace carom
