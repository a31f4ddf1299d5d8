#include "harness/machine/suspensions.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <limits>

#include "harness/support/errors.hpp"
#include "harness/support/process_clock.hpp"

namespace carom {
namespace {

std::atomic<int> times_continued = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a handler of signals may use nothing else");

extern "C" void count_continuation(int /*signal*/) { times_continued.fetch_add(1); }

void handle_continuations() {
    struct sigaction action{};
    action.sa_handler = count_continuation;
    action.sa_flags = SA_RESTART;
    sigaction(SIGCONT, &action, nullptr);
    sigset_t continuation;
    sigemptyset(&continuation);
    sigaddset(&continuation, SIGCONT);
    pthread_sigmask(SIG_UNBLOCK, &continuation, nullptr);
}

/// How long the machine has slept since it was started.
double asleep_seconds() {
    double least = std::numeric_limits<double>::infinity();
    // Whoever is put aside between two looks at a clock sees too much, never too little.
    for (int look = 0; look < 5; ++look) {
        const double awake = seconds_on(CLOCK_MONOTONIC);
        least = std::min(least, seconds_on(CLOCK_BOOTTIME) - awake);
    }
    return least;
}

/// No machine sleeps for less; two looks may differ by what this process was put aside for in both.
constexpr double shortest_sleep = 0.2;

} // namespace

void Suspensions::start() {
    handle_continuations();
    continued_ = times_continued.load();
    asleep_seconds_ = asleep_seconds();
}

bool Suspensions::noticed() const {
    return times_continued.load() != continued_ || asleep_seconds() - asleep_seconds_ > shortest_sleep;
}

std::optional<std::string> Suspensions::reason() const {
    return noticed() ? std::optional<std::string>(
                           "was suspended for some time while it was measured; measure it again")
                     : std::nullopt;
}

void Suspensions::require_none(const std::string& name) const {
    if (const auto why = reason()) {
        throw InputError(name + ": " + *why);
    }
}

} // namespace carom
