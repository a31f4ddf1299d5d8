// A program of its own: it counts what every `new` of the process asks for, and the pages that each thread is
// the first to touch.

#include <cstddef>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include "kernels/parallel_for.hpp"
#include "kernels/probe.hpp"
#include "kernels/state.hpp"
#include "kernels/step.hpp"
#include "kernels/tests/counted_memory.hpp"
#include "kernels/tests/fast_policies.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

using tests::fastest;

/// The most memory that a simulation has held while it was built and took three steps.
std::size_t most_memory(const Scene& scene, int threads) {
    const std::size_t before = tests::memory::held;
    tests::memory::most_held = before;
    State<fastest> state(scene, threads);
    NoProbe probe;
    for (int n = 0; n < 3; ++n) {
        step(state, {.threads = threads}, probe);
    }
    return tests::memory::most_held - before;
}

/// Discs in no order, so that in the first sort each thread's discs lie in all boxes.
TEST(StateMemory, IsTheSameOnAnyNumberOfThreads) {
    const Scene scene = tests::random_scene_of_density(100'000, 0.5, 3, 171);
    const std::size_t one = most_memory(scene, 1);
    for (const int threads : {2, 16, 64, 128, 256}) {
        const std::size_t several = most_memory(scene, threads);
        EXPECT_LT(10 * several, 11 * one) << threads << " threads: " << several << " bytes for " << one;
        EXPECT_GT(10 * several, 9 * one) << threads << " threads: " << several << " bytes for " << one;
    }
}

/// How often each thread has touched a page first.
std::vector<long> faults(int threads) {
    std::vector<long> faults(static_cast<std::size_t>(threads));
    on_each_thread(threads, [&faults](int thread) {
        rusage usage{};
        getrusage(RUSAGE_THREAD, &usage);
        faults[static_cast<std::size_t>(thread)] = usage.ru_minflt;
    });
    return faults;
}

/// The pages that each thread is the first to touch while `work` runs.
template <class Work> std::vector<long> first_touched(int threads, const Work& work) {
    const std::vector<long> before = faults(threads);
    work();
    std::vector<long> touched = faults(threads);
    for (std::size_t k = 0; k < touched.size(); ++k) {
        touched[k] -= before[k];
    }
    return touched;
}

void expect_even(const std::vector<long>& touched, const char* what) {
    const long all = std::accumulate(touched.begin(), touched.end(), 0L);
    const auto threads = static_cast<long>(touched.size());
    for (const long one : touched) {
        EXPECT_NEAR(static_cast<double>(one), static_cast<double>(all) / static_cast<double>(threads),
                    0.1 * static_cast<double>(all))
            << what << ": a thread of " << threads << ", of " << all << " pages";
    }
    EXPECT_GT(all, 300) << what;
}

/// By the thread that will work on them: a quarter each, with a tenth of all for what the test itself
/// touches.
TEST(StateMemory, IsTouchedFirstByAllThreadsAlike) {
    constexpr int threads = 4;
    prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0); // else a page is half a thousand
    mallopt(M_MMAP_THRESHOLD, 1 << 16);    // what is freed goes back, and is new to who gets it next
    const Scene scene = tests::random_scene_of_density(400'000, 0.01, 1, 172);
    NoProbe probe;
    const Tuning tuning{.threads = threads};
    faults(threads);
    std::vector<State<fastest>> states;
    states.reserve(1);
    expect_even(first_touched(threads, [&] { states.emplace_back(scene, threads); }), "the state");
    State<fastest>& state = states.front();
    expect_even(first_touched(threads, [&] { move(state, tuning, probe); }), "the move");
    expect_even(first_touched(threads, [&] { bin(state, tuning, probe); }), "the sort");
}

} // namespace
} // namespace carom
