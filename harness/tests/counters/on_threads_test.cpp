#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <omp.h>
#include <pthread.h>

#include "harness/counters/on_threads.hpp"
#include "harness/support/errors.hpp"
#include "kernels/parallel_for.hpp"

namespace carom {
namespace {

/// Counts what `count` says for its thread; every call must come from the thread that made it.
class CountingSet : public EventSet {
  public:
    explicit CountingSet(std::function<double(int)> count) : count_(std::move(count)) {}
    ~CountingSet() override { EXPECT_TRUE(on_its_thread()); }

    void add(const std::string&) override {
        EXPECT_TRUE(on_its_thread());
        ++events_;
    }
    void start() override {
        EXPECT_TRUE(on_its_thread());
        if (count_(omp_get_thread_num()) < 0) {
            throw CounterError("start is refused");
        }
    }
    std::vector<double> stop() override {
        EXPECT_TRUE(on_its_thread());
        return std::vector<double>(events_, count_(omp_get_thread_num()));
    }

  private:
    bool on_its_thread() const { return pthread_equal(thread_, pthread_self()) != 0; }

    std::function<double(int)> count_;
    pthread_t thread_ = pthread_self();
    std::size_t events_ = 0;
};

MakeEventSet fake(const std::function<double(int)>& count) {
    return [count] { return std::make_unique<CountingSet>(count); };
}

std::string error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const CheckError& error) {
        return error.what();
    }
    return "";
}

TEST(ThreadCounters, KeepEachThreadsOwnAndAddUpFromStartToStop) {
    // Of misses there may be none.
    ThreadCounters counters({"PAPI_L3_TCM", "b"}, fake([](int thread) { return thread; }), 3);
    for (int k = 0; k < 3; ++k) {
        counters.start();
        counters.stop();
    }
    EXPECT_EQ(counters.counts(), (std::vector<std::vector<double>>{{0, 0}, {3, 3}, {6, 6}}));
}

TEST(ThreadCounters, NamesTheThreadThatRefuses) {
    ThreadCounters counters({"a"}, fake([](int thread) { return thread == 2 ? -1 : 1; }), 3);
    const std::string error = error_of([&] { counters.start(); });
    EXPECT_NE(error.find("thread 2 of 3"), std::string::npos) << error;
    EXPECT_NE(error.find("start is refused"), std::string::npos) << error;
}

TEST(ThreadCounters, AThreadWithoutCyclesIsAnError) {
    ThreadCounters counters({"PAPI_TOT_CYC"}, fake([](int thread) { return thread == 1 ? 0 : 5; }), 2);
    counters.start();
    counters.stop();
    const std::string error = error_of([&] { static_cast<void>(counters.counts()); });
    EXPECT_NE(error.find("thread 1 of 2"), std::string::npos) << error;
    EXPECT_NE(error.find("PAPI_TOT_CYC"), std::string::npos) << error;
}

TEST(ThreadCounters, NothingCountedIsAnError) {
    const ThreadCounters counters({"a"}, fake([](int) { return 1; }), 2);
    const std::string error = error_of([&] { static_cast<void>(counters.counts()); });
    EXPECT_NE(error.find("nothing was counted"), std::string::npos) << error;
}

TEST(ThreadCounters, FewerThreadsThanAskedForIsAnError) {
    std::vector<std::string> errors(2);
    on_each_thread(2, [&errors](int thread) {
        // A parallel region within another has one thread.
        errors[static_cast<std::size_t>(thread)] =
            error_of([] { const ThreadCounters counters({"a"}, fake([](int) { return 1; }), 2); });
    });
    EXPECT_NE(errors[0].find("thread 1 of 2: OpenMP gave fewer threads"), std::string::npos) << errors[0];
}

} // namespace
} // namespace carom
