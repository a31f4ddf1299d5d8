#pragma once

#include <chrono>
#include <ctime>
#include <functional>
#include <utility>

namespace carom {

/// Wall time that has passed since then.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

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
        cpu_start_ = cpu_now();
        wall_start_ = std::chrono::steady_clock::now();
    }

    void stop() {
        wall_ += std::chrono::steady_clock::now() - wall_start_;
        cpu_ += cpu_now() - cpu_start_;
        if (after_stop_) {
            after_stop_();
        }
    }

    /// While it runs: the wall time so far, at the cost of one look at the clock.
    double running_wall_seconds() const {
        return std::chrono::duration<double>(wall_ + (std::chrono::steady_clock::now() - wall_start_))
            .count();
    }

    double wall_seconds() const { return std::chrono::duration<double>(wall_).count(); }
    double cpu_seconds() const { return cpu_; }

  private:
    static double cpu_now() {
        timespec now{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    }

    std::function<void()> before_start_;
    std::function<void()> after_stop_;
    std::chrono::steady_clock::time_point wall_start_;
    std::chrono::steady_clock::duration wall_{};
    double cpu_start_ = 0;
    double cpu_ = 0;
};

} // namespace carom
