#pragma once

#include <chrono>
#include <string>
#include <thread>

#include <sys/types.h>

#include "harness/tests/temporary_directory.hpp"

namespace carom::tests {

/// Whether a process is gone within some seconds; where nobody collects orphans a dead one may stay as a
/// zombie.
inline bool is_gone(pid_t process) {
    const std::string stat = "/proc/" + std::to_string(process) + "/stat";
    for (int wait = 0; wait < 500; ++wait) {
        const std::string text = content_of(stat);
        if (text.empty() || text.find(") Z") != std::string::npos) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

} // namespace carom::tests
