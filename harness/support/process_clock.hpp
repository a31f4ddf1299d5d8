#pragma once

#include <chrono>
#include <ctime>

#include <sys/time.h>

namespace carom {

inline double seconds_of(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// What a clock of the system tells, in seconds (man clock_gettime).
inline double seconds_on(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// When the program's static objects were made, just before main.
inline const std::chrono::steady_clock::time_point process_start = std::chrono::steady_clock::now();

/// Seconds of wall time since then, the same in this process and in those that it forks.
inline double process_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - process_start).count();
}

} // namespace carom
