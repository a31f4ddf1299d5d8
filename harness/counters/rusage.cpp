#include "harness/counters/rusage.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include <sys/resource.h>

#include "harness/support/process_clock.hpp"

namespace carom {
namespace {

struct Field {
    std::string_view event;
    double (*value)(const rusage&);
};

constexpr std::array<Field, 6> fields{
    {{"user_seconds", [](const rusage& usage) { return seconds_of(usage.ru_utime); }},
     {"system_seconds", [](const rusage& usage) { return seconds_of(usage.ru_stime); }},
     {"minor_page_faults", [](const rusage& usage) { return static_cast<double>(usage.ru_minflt); }},
     {"major_page_faults", [](const rusage& usage) { return static_cast<double>(usage.ru_majflt); }},
     {"voluntary_context_switches", [](const rusage& usage) { return static_cast<double>(usage.ru_nvcsw); }},
     {"involuntary_context_switches",
      [](const rusage& usage) { return static_cast<double>(usage.ru_nivcsw); }}}};

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

class RusageEventSet : public EventSet {
  public:
    void add(const std::string& event) override {
        for (const Field& field : fields) {
            if (field.event == event) {
                added_.push_back(&field);
                return;
            }
        }
        throw CounterError("getrusage knows no " + event);
    }

    void start() override { start_ = usage_of(RUSAGE_THREAD); }

    std::vector<double> stop() override {
        const rusage now = usage_of(RUSAGE_THREAD);
        std::vector<double> counts;
        for (const Field* field : added_) {
            counts.push_back(field->value(now) - field->value(start_));
        }
        return counts;
    }

  private:
    std::vector<const Field*> added_;
    rusage start_{};
};

} // namespace

std::vector<std::string> rusage_events() {
    std::vector<std::string> names;
    for (const Field& field : fields) {
        names.emplace_back(field.event);
    }
    return names;
}

std::unique_ptr<EventSet> rusage_event_set() { return std::make_unique<RusageEventSet>(); }

double maximum_resident_bytes() { return 1024.0 * static_cast<double>(usage_of(RUSAGE_SELF).ru_maxrss); }

} // namespace carom
