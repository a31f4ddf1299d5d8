#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "harness/processes/process_end.hpp"

namespace carom {

/// What a program prints, as it comes: its end is kept and the rest only counted, so that however much it is
/// takes no more memory. A file may take all of it, up to 256 MiB.
class OutputTail {
  public:
    /// `file` is where it goes besides, or empty. One that cannot be written holds less than was printed.
    explicit OutputTail(const std::string& file) {
        if (!file.empty()) {
            file_ = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        }
    }
    ~OutputTail() { close(file_); }
    OutputTail(const OutputTail&) = delete;
    OutputTail& operator=(const OutputTail&) = delete;

    void take(std::span<const char> bytes) {
        if (file_ >= 0 && printed_.bytes < most_bytes_in_file &&
            write(file_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
            close(file_);
            file_ = -1;
        }
        printed_.bytes += static_cast<std::int64_t>(bytes.size());
        printed_.end.append(bytes.data(), bytes.size());
        keep_end(2 * kept_bytes);
    }

    /// All of it, once nothing comes any more.
    Printed printed() {
        keep_end(kept_bytes);
        return printed_;
    }

  private:
    static constexpr std::size_t kept_bytes = 65536;
    static constexpr std::int64_t most_bytes_in_file = 1 << 28;

    void keep_end(std::size_t most) {
        if (printed_.end.size() > most) {
            printed_.end.erase(0, printed_.end.size() - kept_bytes);
        }
    }

    int file_ = -1;
    Printed printed_;
};

} // namespace carom
