#include "harness/support/process_clock.hpp"

#include <chrono>

#include "harness/support/stopwatch.hpp"

namespace carom {
namespace {

const auto process_start = std::chrono::steady_clock::now();

} // namespace

double process_seconds() { return seconds_since(process_start); }

} // namespace carom
