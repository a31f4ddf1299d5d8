#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/counters/event_set.hpp"

namespace carom {

/// The same events on each thread of a team of OpenMP threads, one set a thread, which its own thread makes,
/// starts, stops and gives back. May be started and stopped several times; what is counted adds up. Throws
/// CheckError if a thread refuses, is missing or reports nothing.
class ThreadCounters {
  public:
    ThreadCounters(std::vector<std::string> events, const MakeEventSet& make, int threads);
    ~ThreadCounters();
    ThreadCounters(const ThreadCounters&) = delete;
    ThreadCounters& operator=(const ThreadCounters&) = delete;

    void start();
    void stop();

    /// Per thread, what was counted, in the order of the events.
    std::vector<std::vector<double>> counts() const;

  private:
    struct Thread {
        std::unique_ptr<EventSet> set;
        std::optional<unsigned long> identity; ///< of the system's thread that made the set
        std::vector<double> counts;
        std::string error;
    };

    void on_each(const std::function<void(Thread&)>& body);
    static void require_same(const Thread& thread);
    void require_counts(const Thread& thread, const std::string& where) const;

    std::vector<std::string> events_;
    std::vector<Thread> threads_;
};

} // namespace carom
