#include "harness/support/process_clock.hpp"

#include <chrono>

namespace carom {
namespace {

const auto process_start = std::chrono::steady_clock::now();

} // namespace

double process_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - process_start).count();
}

} // namespace carom
