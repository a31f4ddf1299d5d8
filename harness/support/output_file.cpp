#include "harness/support/output_file.hpp"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <iostream>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "harness/support/errors.hpp"

namespace carom {

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code absent;
    const auto status = std::filesystem::status(path_, absent);
    if (std::filesystem::is_directory(status)) {
        errno = EISDIR;
        refuse("cannot be written");
    }
    const bool special = std::filesystem::is_other(status);
    if (!special) {
        temporary_ = path_.string() + ".part" + std::to_string(getpid());
    }
    descriptor_ =
        open((special ? path_ : temporary_).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
        refuse("cannot be written");
    }
}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) {
        close(descriptor_);
        if (!temporary_.empty()) {
            unlink(temporary_.c_str());
        }
    }
}

void OutputFile::write(std::string_view text) {
    while (!text.empty()) {
        const auto written = ::write(descriptor_, text.data(), text.size());
        if (written < 0 && errno != EINTR) {
            refuse("writing broke off");
        }
        text.remove_prefix(static_cast<std::size_t>(written < 0 ? 0 : written));
    }
}

void OutputFile::finish() {
    const bool renamed =
        temporary_.empty() || (fsync(descriptor_) == 0 && rename(temporary_.c_str(), path_.c_str()) == 0);
    if (!renamed) {
        refuse("cannot be completed");
    }
    close(std::exchange(descriptor_, -1));
}

void OutputFile::refuse(const char* what) const {
    throw InputError(path_.string() + ": " + what + " (" + std::strerror(errno) +
                     "), expected a writable place with room");
}

bool is_standard_output(const std::filesystem::path& path) { return path.empty() || path == "-"; }

void require_writable(const std::filesystem::path& path) {
    std::error_code absent;
    // Opening a pipe would wait for whoever reads it.
    if (!is_standard_output(path) && !std::filesystem::is_other(std::filesystem::status(path, absent))) {
        const OutputFile probe(path);
    }
}

void write_text(const std::filesystem::path& path, std::string_view text) {
    if (is_standard_output(path)) {
        std::cout << text;
        return;
    }
    OutputFile file(path);
    file.write(text);
    file.finish();
}

} // namespace carom
