#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <fcntl.h>
#include <unistd.h>

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
        if (file_ >= 0 && bytes_ < most_bytes_in_file &&
            write(file_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
            close(file_);
            file_ = -1;
        }
        bytes_ += static_cast<std::int64_t>(bytes.size());
        end_.append(bytes.data(), bytes.size());
        end_.erase(0, end_.size() - std::min(end_.size(), kept_bytes));
    }

    /// How much it was.
    std::int64_t bytes() const { return bytes_; }

    /// The last of it: enough to know what kind of program it is.
    const std::string& end() const { return end_; }

  private:
    static constexpr std::size_t kept_bytes = 4096;
    static constexpr std::int64_t most_bytes_in_file = 1 << 28;

    int file_ = -1;
    std::int64_t bytes_ = 0;
    std::string end_;
};

} // namespace carom
