#pragma once

#include <omp.h>

#include "policies.hpp"
#include "probe.hpp"
#include "tally.hpp"

// Every OpenMP pragma of the project stands in this file.

namespace carom {

#pragma omp declare reduction(+ : Tally : omp_out += omp_in)

/// Runs `body(i)`, which returns a Tally, for i in [0, count) on `threads` threads under the given schedule,
/// and returns the sum. Iterations must not write what another one reads. `chunk` must be positive and counts
/// only where the schedule has one. Exceptions must not leave `body`.
template <Schedule schedule, class SomeProbe, class Body>
Tally parallel_for(int threads, int count, [[maybe_unused]] int chunk, SomeProbe& probe, const Body& body) {
    Tally tally;
#pragma omp parallel num_threads(threads) reduction(+ : tally)
    {
        const int thread = omp_get_thread_num();
        const auto iterate = [&](int i) {
            probe.iteration(thread, i);
            tally += body(i);
        };
        probe.loop_begin(thread);
        if constexpr (schedule == Schedule::static_) {
#pragma omp for schedule(static) nowait
            for (int i = 0; i < count; ++i) {
                iterate(i);
            }
        } else if constexpr (schedule == Schedule::static_chunk) {
#pragma omp for schedule(static, chunk) nowait
            for (int i = 0; i < count; ++i) {
                iterate(i);
            }
        } else if constexpr (schedule == Schedule::dynamic) {
#pragma omp for schedule(dynamic) nowait
            for (int i = 0; i < count; ++i) {
                iterate(i);
            }
        } else if constexpr (schedule == Schedule::dynamic_chunk) {
#pragma omp for schedule(dynamic, chunk) nowait
            for (int i = 0; i < count; ++i) {
                iterate(i);
            }
        } else if constexpr (schedule == Schedule::guided) {
#pragma omp for schedule(guided) nowait
            for (int i = 0; i < count; ++i) {
                iterate(i);
            }
        } else {
#pragma omp for schedule(guided, chunk) nowait
            for (int i = 0; i < count; ++i) {
                iterate(i);
            }
        }
        probe.loop_end(thread);
#pragma omp barrier
        probe.barrier_end(thread);
    }
    return tally;
}

/// Runs `body(thread)` once on each of the same threads that `parallel_for` with as many threads uses.
template <class Body> void on_each_thread(int threads, const Body& body) {
#pragma omp parallel num_threads(threads)
    body(omp_get_thread_num());
}

} // namespace carom
