#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/parallel_for.hpp"
#include "kernels/policies.hpp"
#include "kernels/probe.hpp"
#include "kernels/state.hpp"

namespace carom {
namespace {

/// What each thread was seen to do in one loop.
class Recorder {
  public:
    explicit Recorder(int threads) : threads_(static_cast<std::size_t>(threads)) {}

    void loop_begin(int thread) { ++of(thread).begins; }
    void wait_begin(int thread) { ++of(thread).waits_begun; }
    void wait_end(int thread) { ++of(thread).waits_ended; }
    void iteration(int thread, int index) { of(thread).iterations.push_back(index); }
    void loop_end(int thread) {
        ++of(thread).ends;
        ++ended_;
    }
    void barrier_end(int thread) {
        ++of(thread).barriers;
        if (ended_ != static_cast<int>(threads_.size())) {
            all_had_ended_ = false;
        }
    }

    struct Thread {
        int begins = 0;
        int waits_begun = 0;
        int waits_ended = 0;
        int ends = 0;
        int barriers = 0;
        std::vector<int> iterations;
    };

    const std::vector<Thread>& threads() const { return threads_; }

    /// Had every thread ended its loop whenever one came through the barrier?
    bool all_had_ended() const { return all_had_ended_; }

  private:
    Thread& of(int thread) { return threads_.at(static_cast<std::size_t>(thread)); }

    std::vector<Thread> threads_;
    std::atomic<int> ended_ = 0;
    std::atomic<bool> all_had_ended_ = true;
};

template <Schedule value> struct Of {
    static constexpr Schedule schedule = value;
};

template <class> class ParallelFor : public testing::Test {};

using Schedules =
    testing::Types<Of<Schedule::static_>, Of<Schedule::static_chunk>, Of<Schedule::dynamic>,
                   Of<Schedule::dynamic_chunk>, Of<Schedule::guided>, Of<Schedule::guided_chunk>>;
TYPED_TEST_SUITE(ParallelFor, Schedules, );

TYPED_TEST(ParallelFor, RunsEveryIterationOnceAndAddsUpTheirTallies) {
    for (const int threads : {1, 2, 3, 8}) {
        for (const int count : {0, 1, 2, 7, 1000}) {
            for (const int chunk : {1, 4, 2000}) {
                SCOPED_TRACE(testing::Message()
                             << threads << " threads, " << count << " in chunks of " << chunk);
                Recorder recorder(threads);
                std::vector<int> runs(static_cast<std::size_t>(count));
                const Tally tally =
                    parallel_for<TypeParam::schedule>(threads, count, chunk, recorder, [&runs](int i) {
                        ++runs[static_cast<std::size_t>(i)];
                        return Tally{.overlaps = i, .pair_resolves = 1, .wall_resolves = 2, .sweeps = 3};
                    });
                EXPECT_TRUE(std::ranges::all_of(runs, [](int times) { return times == 1; }));
                const std::int64_t each = count;
                EXPECT_EQ(tally, (Tally{.overlaps = each * (each - 1) / 2,
                                        .pair_resolves = each,
                                        .wall_resolves = 2 * each,
                                        .sweeps = 3 * each}));
            }
        }
    }
}

TYPED_TEST(ParallelFor, RemembersASingleIterationThatDidNotSettle) {
    Recorder recorder(3);
    const auto run = [&recorder](int unsettled) {
        return parallel_for<TypeParam::schedule>(
            3, 50, 4, recorder, [unsettled](int i) { return Tally{.settled = i != unsettled}; });
    };
    EXPECT_FALSE(run(37).settled);
    EXPECT_TRUE(run(-1).settled);
}

TYPED_TEST(ParallelFor, TellsTheProbeOfEveryThreadItAskedFor) {
    for (const int threads : {1, 3, 8}) {
        SCOPED_TRACE(threads);
        Recorder recorder(threads);
        parallel_for<TypeParam::schedule>(threads, 100, 4, recorder, [](int) { return Tally{}; });
        EXPECT_TRUE(recorder.all_had_ended());
        std::vector<int> iterations;
        for (const Recorder::Thread& thread : recorder.threads()) {
            EXPECT_EQ(thread.begins, 1);
            EXPECT_EQ(thread.ends, 1);
            EXPECT_EQ(thread.barriers, 1);
            iterations.insert(iterations.end(), thread.iterations.begin(), thread.iterations.end());
        }
        std::ranges::sort(iterations);
        ASSERT_EQ(iterations.size(), 100u);
        for (int i = 0; i < 100; ++i) {
            EXPECT_EQ(iterations[static_cast<std::size_t>(i)], i);
        }
    }
}

/// Each iteration needs what the one so far before it has written: without waiting for it, on several
/// threads, it would read a 0.
TYPED_TEST(ParallelFor, BeginsAnIterationWhenItIsReady) {
    constexpr int count = 2000;
    constexpr int before = 3;
    for (const int threads : {1, 2, 3, 8}) {
        SCOPED_TRACE(threads);
        Recorder recorder(threads);
        std::vector<int> written(count);
        std::vector<std::atomic<bool>> is_written(count);
        parallel_for<TypeParam::schedule>(
            threads, count, 4, recorder,
            [&](int i) {
                written.at(static_cast<std::size_t>(i)) =
                    i < before ? 1 : written.at(static_cast<std::size_t>(i - before)) + 1;
                is_written.at(static_cast<std::size_t>(i)).store(true, std::memory_order_release);
                return Tally{};
            },
            [&](int i) {
                return i < before ||
                       is_written.at(static_cast<std::size_t>(i - before)).load(std::memory_order_acquire);
            });
        for (int i = 0; i < count; ++i) {
            EXPECT_EQ(written.at(static_cast<std::size_t>(i)), i / before + 1);
        }
        for (const Recorder::Thread& thread : recorder.threads()) {
            EXPECT_EQ(thread.waits_begun, thread.waits_ended);
            EXPECT_LE(thread.waits_begun, std::ssize(thread.iterations));
        }
    }
}

TEST(Waiting, IsToldOnlyWhereAnIterationIsNotReady) {
    for (const bool late : {false, true}) {
        Recorder recorder(1);
        bool asked = !late;
        parallel_for<Schedule::dynamic>(
            1, 5, 1, recorder, [](int) { return Tally{}; },
            [&asked](int i) { return i != 3 || std::exchange(asked, true); });
        EXPECT_EQ(recorder.threads()[0].waits_begun, late ? 1 : 0);
        EXPECT_EQ(recorder.threads()[0].waits_ended, late ? 1 : 0);
    }
}

TEST(StaticChunk, DealsChunksInTurn) {
    Recorder recorder(3);
    parallel_for<Schedule::static_chunk>(3, 10, 2, recorder, [](int) { return Tally{}; });
    EXPECT_EQ(recorder.threads()[0].iterations, (std::vector<int>{0, 1, 6, 7}));
    EXPECT_EQ(recorder.threads()[1].iterations, (std::vector<int>{2, 3, 8, 9}));
    EXPECT_EQ(recorder.threads()[2].iterations, (std::vector<int>{4, 5}));
}

TEST(Static, GivesEachThreadOneRun) {
    Recorder recorder(2);
    parallel_for<Schedule::static_>(2, 8, 2, recorder, [](int) { return Tally{}; });
    EXPECT_EQ(recorder.threads()[0].iterations, (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(recorder.threads()[1].iterations, (std::vector<int>{4, 5, 6, 7}));
}

/// Do all iterations come to a thread in runs of whole chunks, the last of the loop excepted?
bool in_chunks(const Recorder& recorder, int count, int chunk) {
    for (const Recorder::Thread& thread : recorder.threads()) {
        for (const int i : thread.iterations) {
            const int last = std::min((i / chunk + 1) * chunk, count) - 1;
            if (std::ranges::find(thread.iterations, last) == thread.iterations.end()) {
                return false;
            }
        }
    }
    return true;
}

TEST(DynamicChunk, HandsOutWholeChunks) {
    Recorder recorder(3);
    parallel_for<Schedule::dynamic_chunk>(3, 103, 10, recorder, [](int) { return Tally{}; });
    EXPECT_TRUE(in_chunks(recorder, 103, 10));
}

} // namespace
} // namespace carom
