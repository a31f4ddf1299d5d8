#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pthread.h>

#include "harness/counters/event_set.hpp"
#include "harness/counters/groups.hpp"
#include "harness/support/errors.hpp"
#include "kernels/parallel_for.hpp"

namespace carom {

/// The same events on each thread of a team of OpenMP threads, one set a thread, which its own thread makes,
/// starts, stops and gives back. May be started and stopped several times; what is counted adds up. Throws
/// CheckError if a thread refuses, is missing or reports nothing.
class ThreadCounters {
  public:
    ThreadCounters(std::vector<std::string> events, const MakeEventSet& make, int threads)
        : events_(std::move(events)), threads_(static_cast<std::size_t>(threads)) {
        on_each([&](Thread& thread) {
            thread.set = make();
            for (const std::string& event : events_) {
                thread.set->add(event);
            }
            thread.identity = pthread_self();
        });
    }

    ~ThreadCounters() {
        on_each_thread(static_cast<int>(threads_.size()),
                       [this](int thread) { threads_[static_cast<std::size_t>(thread)].set.reset(); });
    }

    ThreadCounters(const ThreadCounters&) = delete;
    ThreadCounters& operator=(const ThreadCounters&) = delete;

    void start() {
        on_each([](Thread& thread) {
            require_same(thread);
            thread.set->start();
        });
    }

    void stop() {
        on_each([this](Thread& thread) {
            require_same(thread);
            const std::vector<double> counts = thread.set->stop();
            thread.counts.resize(events_.size());
            for (std::size_t k = 0; k < events_.size(); ++k) {
                thread.counts[k] += counts.at(k);
            }
        });
    }

    /// Per thread, what was counted, in the order of the events.
    std::vector<std::vector<double>> counts() const {
        std::vector<std::vector<double>> counts;
        for (std::size_t i = 0; i < threads_.size(); ++i) {
            require_counts(threads_[i], place(i, threads_.size()));
            counts.push_back(threads_[i].counts);
        }
        return counts;
    }

  private:
    struct Thread {
        std::unique_ptr<EventSet> set;
        std::optional<unsigned long> identity; ///< of the system's thread that made the set
        std::vector<double> counts;
        std::string error;
    };

    static std::string place(std::size_t thread, std::size_t threads) {
        return "counters, thread " + std::to_string(thread) + " of " + std::to_string(threads) + ": ";
    }

    /// Exceptions must not leave the parallel region: an error is thrown after it.
    void on_each(const std::function<void(Thread&)>& body) {
        on_each_thread(static_cast<int>(threads_.size()), [&](int number) {
            Thread& thread = threads_[static_cast<std::size_t>(number)];
            try {
                body(thread);
            } catch (const std::exception& error) {
                thread.error = error.what();
            }
        });
        for (std::size_t i = 0; i < threads_.size(); ++i) {
            const Thread& thread = threads_[i];
            if (!thread.error.empty()) {
                throw CheckError(place(i, threads_.size()) + thread.error);
            }
            if (!thread.identity) {
                throw CheckError(place(i, threads_.size()) + "OpenMP gave fewer threads than were asked for");
            }
        }
    }

    static void require_same(const Thread& thread) {
        if (thread.identity != pthread_self()) {
            throw CounterError("OpenMP has replaced the thread that was made ready to count");
        }
    }

    void require_counts(const Thread& thread, const std::string& where) const {
        if (thread.counts.size() != events_.size()) {
            throw CheckError(where + "nothing was counted");
        }
        for (std::size_t k = 0; k < events_.size(); ++k) {
            if (must_count(events_[k]) && !(thread.counts[k] > 0)) {
                throw CheckError(where + "no " + events_[k] + " counted, although it ran");
            }
        }
    }

    std::vector<std::string> events_;
    std::vector<Thread> threads_;
};

} // namespace carom
