#pragma once

#include <type_traits>

#include <omp.h>
#include <sched.h>

#include "policies.hpp"
#include "probe.hpp"
#include "tally.hpp"

// Every OpenMP pragma of the project stands in this file.

namespace carom {

/// How much memory, in bytes, moves between processors at a time: what different threads write lies as far
/// apart. True of x86-64 and most of Arm; where lines are longer, threads are slower and results the same.
/// (std::hardware_destructive_interference_size varies with -mtune, and clang 14 lacks it.)
inline constexpr int cache_line = 64;

#pragma omp declare reduction(+ : Tally : omp_out += omp_in)

/// For iterations that need not wait for others.
struct Always {
    constexpr bool operator()(int /*i*/) const { return true; }
};

/// How often a thread asks whether its iteration can begin before it lets others run in between.
inline constexpr int patience = 10'000;

/// Waits until `ready(i)`.
template <class SomeProbe, class Ready> void await(int i, const Ready& ready, int thread, SomeProbe& probe) {
    probe.wait_begin(thread);
    for (int asked = 1; !ready(i); ++asked) {
        if (asked % patience == 0) {
            sched_yield();
        }
    }
    probe.wait_end(thread);
}

/// Runs `body(row, column, tally)` for each row in [0, rows) and column in [0, columns), row by row, as the
/// iterations of one loop on `threads` threads under the given schedule, and returns the sum of what the
/// bodies add to their tallies. Iterations must not write what another one reads, unless `ready` keeps them
/// apart: an iteration begins when `ready(i)` is true, i counting all iterations. What makes it true must be
/// among the iterations before i; since each thread takes its iterations in rising order, the first one not
/// done can then always go on. `chunk` must be positive and counts only where the schedule has one.
/// Exceptions must not leave `body`.
template <Schedule schedule, class SomeProbe, class Body, class Ready = Always>
Tally parallel_for_boxes(int threads, int rows, int columns, [[maybe_unused]] int chunk, SomeProbe& probe,
                         const Body& body, const Ready& ready = {}) {
    Tally total;
#pragma omp parallel num_threads(threads) reduction(+ : total)
    {
        Tally tally; // not shared with the runtime: it may stay in registers
        const int thread = omp_get_thread_num();
        const auto iterate = [&](int row, int column) {
            const int i = row * columns + column;
            if (!ready(i)) {
                await(i, ready, thread, probe);
            }
            probe.iteration(thread, i);
            body(row, column, tally);
        };
        probe.loop_begin(thread);
        if constexpr (schedule == Schedule::static_) {
#pragma omp for schedule(static) collapse(2) nowait
            for (int row = 0; row < rows; ++row) {
                for (int column = 0; column < columns; ++column) {
                    iterate(row, column);
                }
            }
        } else if constexpr (schedule == Schedule::static_chunk) {
#pragma omp for schedule(static, chunk) collapse(2) nowait
            for (int row = 0; row < rows; ++row) {
                for (int column = 0; column < columns; ++column) {
                    iterate(row, column);
                }
            }
        } else if constexpr (schedule == Schedule::dynamic) {
#pragma omp for schedule(monotonic : dynamic) collapse(2) nowait
            for (int row = 0; row < rows; ++row) {
                for (int column = 0; column < columns; ++column) {
                    iterate(row, column);
                }
            }
        } else if constexpr (schedule == Schedule::dynamic_chunk) {
#pragma omp for schedule(monotonic : dynamic, chunk) collapse(2) nowait
            for (int row = 0; row < rows; ++row) {
                for (int column = 0; column < columns; ++column) {
                    iterate(row, column);
                }
            }
        } else if constexpr (schedule == Schedule::guided) {
#pragma omp for schedule(monotonic : guided) collapse(2) nowait
            for (int row = 0; row < rows; ++row) {
                for (int column = 0; column < columns; ++column) {
                    iterate(row, column);
                }
            }
        } else {
#pragma omp for schedule(monotonic : guided, chunk) collapse(2) nowait
            for (int row = 0; row < rows; ++row) {
                for (int column = 0; column < columns; ++column) {
                    iterate(row, column);
                }
            }
        }
        probe.loop_end(thread);
        if constexpr (!std::is_same_v<SomeProbe, NoProbe>) { // whom the end of the region, a barrier, will do
#pragma omp barrier
            probe.barrier_end(thread);
        }
        total += tally;
    }
    return total;
}

/// The same for i in [0, count): runs `body(i)`, which returns a Tally, and returns the sum.
template <Schedule schedule, class SomeProbe, class Body, class Ready = Always>
Tally parallel_for(int threads, int count, int chunk, SomeProbe& probe, const Body& body,
                   const Ready& ready = {}) {
    return parallel_for_boxes<schedule>(
        threads, count, 1, chunk, probe, [&](int i, int /*column*/, Tally& tally) { tally += body(i); },
        ready);
}

/// Runs `body(thread)` once on each of the same threads that `parallel_for` with as many threads uses.
template <class Body> void on_each_thread(int threads, const Body& body) {
#pragma omp parallel num_threads(threads)
    body(omp_get_thread_num());
}

} // namespace carom
