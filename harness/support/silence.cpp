#include "harness/support/silence.hpp"

#include <cstdio>

#include <fcntl.h>
#include <unistd.h>

namespace carom {

Silence::Silence() {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0) {
        std::fflush(stderr);
        standard_error_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
        if (standard_error_ >= 0) {
            dup2(nowhere, STDERR_FILENO);
        }
        close(nowhere);
    }
}

Silence::~Silence() {
    if (standard_error_ >= 0) {
        std::fflush(stderr);
        dup2(standard_error_, STDERR_FILENO);
        close(standard_error_);
    }
}

} // namespace carom
