#include "harness/counters/rusage.hpp"

#include <cerrno>
#include <cstring>

#include "harness/support/usage.hpp"

namespace carom {
namespace {

/// Reading the thread's CPU clock first makes Linux bring up to date what getrusage tells, which would be as
/// old as the last clock tick. The sum of user and system time is exact then; how it divides stays a sample.
rusage usage_of(int who) {
    seconds_on(CLOCK_THREAD_CPUTIME_ID);
    rusage usage{};
    if (getrusage(who, &usage) != 0) {
        throw CounterError(std::string("getrusage: ") + std::strerror(errno));
    }
    return usage;
}

/// Counts all of them.
class RusageEventSet : public EventSet {
  public:
    void add(const std::string& /*event*/) override {}
    void start() override { start_ = usage_of(RUSAGE_THREAD); }
    std::vector<double> stop() override {
        const auto now = counts_of(usage_of(RUSAGE_THREAD));
        const auto before = counts_of(start_);
        std::vector<double> counts;
        for (std::size_t k = 0; k < now.size(); ++k) {
            counts.push_back(now[k].second - before[k].second);
        }
        return counts;
    }

  private:
    rusage start_{};
};

} // namespace

std::vector<std::string> rusage_events() {
    std::vector<std::string> names;
    for (const auto& [name, value] : counts_of({})) {
        names.push_back(name);
    }
    return names;
}

std::unique_ptr<EventSet> rusage_event_set() { return std::make_unique<RusageEventSet>(); }

double maximum_resident_bytes() { return 1024.0 * static_cast<double>(usage_of(RUSAGE_SELF).ru_maxrss); }

} // namespace carom
