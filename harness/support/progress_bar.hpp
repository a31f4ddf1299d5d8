#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>

#include <unistd.h>

#include "harness/support/process_clock.hpp"

namespace carom {

/// A bar with the time left on standard error, if that is a terminal and the work takes more than two
/// seconds.
class ProgressBar {
  public:
    ProgressBar(std::string label, int total)
        : label_(std::move(label)), total_(total), on_terminal_(isatty(STDERR_FILENO) != 0),
          start_(process_seconds()), next_(start_ + 2) {}

    /// Is there anybody to show it to?
    bool on_terminal() const { return on_terminal_; }

    /// Shows that `done` of the total are done, ten times a second at most.
    void show(int done) {
        if (!on_terminal_) {
            return;
        }
        const double now = process_seconds();
        if (now < next_ || done <= 0) {
            return;
        }
        next_ = now + 0.1;
        constexpr int width = 40;
        const double share = static_cast<double>(done) / total_;
        const auto filled = static_cast<std::size_t>(share * width);
        const std::string bar = std::string(filled, '=') + std::string(width - filled, ' ');
        std::fprintf(stderr, "\r%s [%s] %3.0f %%, %.0f s left ", label_.c_str(), bar.c_str(), 100 * share,
                     (now - start_) * (1 - share) / share);
        shown_ = true;
    }

    /// Wipes the bar from the terminal.
    void clear() {
        if (shown_) {
            std::fputs("\r\033[K", stderr);
            shown_ = false;
        }
    }

  private:
    std::string label_;
    int total_;
    bool on_terminal_;
    bool shown_ = false;
    double start_;
    double next_;
};

} // namespace carom
