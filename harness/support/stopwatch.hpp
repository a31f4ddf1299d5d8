#pragma once

#include <functional>
#include <utility>

#include "harness/support/process_clock.hpp"

namespace carom {

/// Adds up wall and process CPU time between starts and stops. Whoever keeps a clock of their own beside it
/// is told of each, just outside the time that counts.
class Stopwatch {
  public:
    Stopwatch() = default;
    Stopwatch(std::function<void()> before_start, std::function<void()> after_stop)
        : before_start_(std::move(before_start)), after_stop_(std::move(after_stop)) {}

    void start() {
        if (before_start_) {
            before_start_();
        }
        cpu_start_ = seconds_on(CLOCK_PROCESS_CPUTIME_ID);
        wall_start_ = process_seconds();
    }

    void stop() {
        wall_ = running_wall_seconds();
        cpu_ += seconds_on(CLOCK_PROCESS_CPUTIME_ID) - cpu_start_;
        if (after_stop_) {
            after_stop_();
        }
    }

    /// While it runs: the wall time so far, at the cost of one look at the clock.
    double running_wall_seconds() const { return wall_ + (process_seconds() - wall_start_); }

    double wall_seconds() const { return wall_; }
    double cpu_seconds() const { return cpu_; }

  private:
    std::function<void()> before_start_;
    std::function<void()> after_stop_;
    double wall_start_ = 0;
    double wall_ = 0;
    double cpu_start_ = 0;
    double cpu_ = 0;
};

} // namespace carom
