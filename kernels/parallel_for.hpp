#pragma once

#include <cassert>
#include <type_traits>

#include <omp.h>
#include <sched.h>

#include "policies.hpp"
#include "probe.hpp"

// Every OpenMP pragma of the project stands in this file.

namespace carom {

/// How much memory, in bytes, moves between processors at a time: what different threads write lies as far
/// apart. True of x86-64 and most of Arm; where lines are longer, threads are slower and results the same.
/// (std::hardware_destructive_interference_size varies with -mtune, and clang 14 lacks it.)
inline constexpr int cache_line = 64;

/// For iterations that need not wait for others.
struct Always {
    constexpr bool operator()(int /*i*/) const { return true; }
};

/// Leaves what a core can do to its other thread for a moment.
inline void relax() {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
}

/// How often a thread asks whether its iteration can begin before it lets others run in between: with a pause
/// a look takes 25 ns and without one 1 ns (EPYC, Zen 4), so that 400 of them take as long as 10 000 did.
inline constexpr int patience = 400;

/// Waits until `ready(i)`.
template <class SomeProbe, class Ready> void await(int i, const Ready& ready, int thread, SomeProbe& probe) {
    probe.wait_begin(thread);
    for (int asked = 1; !ready(i); ++asked) {
        relax();
        if (asked % patience == 0) {
            sched_yield();
        }
    }
    probe.wait_end(thread);
}

/// Runs `iterate(i)` for those i in [0, count) that the schedule gives to the calling thread, in rising
/// order. To be called by every thread of a parallel region.
template <Schedule schedule, class Iterate>
[[gnu::always_inline]] inline void iterate_own(int count, int chunk, const Iterate& iterate) {
    [[maybe_unused]] const int size = has_chunk(schedule) ? chunk : 1; // as where no chunk is named
    if constexpr (schedule == Schedule::static_) {
#pragma omp for schedule(static) nowait
        for (int i = 0; i < count; ++i) {
            iterate(i);
        }
    } else if constexpr (schedule == Schedule::static_chunk) {
#pragma omp for schedule(static, size) nowait
        for (int i = 0; i < count; ++i) {
            iterate(i);
        }
    } else if constexpr (schedule == Schedule::dynamic || schedule == Schedule::dynamic_chunk) {
#pragma omp for schedule(monotonic : dynamic, size) nowait
        for (int i = 0; i < count; ++i) {
            iterate(i);
        }
    } else {
#pragma omp for schedule(monotonic : guided, size) nowait
        for (int i = 0; i < count; ++i) {
            iterate(i);
        }
    }
}

/// Runs `body(i, sum)` for each i in [0, count), as the iterations of one loop on `threads` threads under the
/// given schedule, and returns the sum of what the bodies add to their sums. Each thread has a copy of `body`
/// and takes its iterations in rising order. Iterations must not write what another one reads, unless `ready`
/// keeps them apart: an iteration begins when `ready(i)` is true. What makes it true must be among the
/// iterations before i; then the first one not done can always go on. `chunk` must be positive and counts
/// only where the schedule has one. Exceptions must not leave `body`.
template <Schedule schedule, class Sum, class SomeProbe, class Body, class Ready>
Sum sum_in_parallel(int threads, int count, int chunk, SomeProbe& probe, const Body& body,
                    const Ready& ready) {
    Sum total;
#pragma omp declare reduction(add:Sum : omp_out += omp_in)
#pragma omp parallel num_threads(threads) reduction(add : total)
    {
        Sum sum; // not shared with the runtime: it may stay in registers
        Body own_body(body);
        const int thread = omp_get_thread_num();
        probe.loop_begin(thread);
        iterate_own<schedule>(count, chunk, [&](int i) {
            if (!ready(i)) {
                await(i, ready, thread, probe);
            }
            probe.iteration(thread, i);
            own_body(i, sum);
        });
        probe.loop_end(thread);
        if constexpr (!std::is_same_v<SomeProbe, NoProbe>) { // whom the end of the region, a barrier, will do
#pragma omp barrier
            probe.barrier_end(thread);
        }
        total += sum;
    }
    return total;
}

/// Of bodies that return nothing.
struct NoSum {
    NoSum& operator+=(const NoSum& /*other*/) { return *this; }
};

/// The same with `body(i)`; returns the sum of what the bodies return.
template <Schedule schedule, class SomeProbe, class Body, class Ready = Always>
auto parallel_for(int threads, int count, int chunk, SomeProbe& probe, const Body& body,
                  const Ready& ready = {}) {
    using Result = std::invoke_result_t<const Body&, int>;
    using Sum = std::conditional_t<std::is_void_v<Result>, NoSum, Result>;
    const auto add = [&body](int i, [[maybe_unused]] Sum& sum) {
        if constexpr (std::is_void_v<Result>) {
            body(i);
        } else {
            sum += body(i);
        }
    };
    return sum_in_parallel<schedule, Sum>(threads, count, chunk, probe, add, ready);
}

/// The same with `body(row, column, sum)` for each row in [0, rows) and column in [0, columns), row by row:
/// chunks and shares count boxes, and need not end where a row does.
template <Schedule schedule, class Sum, class SomeProbe, class Body>
Sum parallel_for_boxes(int threads, int rows, int columns, int chunk, SomeProbe& probe, const Body& body) {
    const auto add = [&body, columns, row = 0, row_begin = 0](int i, Sum& sum) mutable {
        assert(i >= row_begin);
        if (i - row_begin >= columns) { // only in another row than before a quotient is needed
            row = i / columns;
            row_begin = row * columns;
        }
        body(row, i - row_begin, sum);
    };
    return sum_in_parallel<schedule, Sum>(threads, rows * columns, chunk, probe, add, Always());
}

/// Runs `body(thread)` once on each of the same threads that `parallel_for` with as many threads uses.
template <class Body> void on_each_thread(int threads, const Body& body) {
#pragma omp parallel num_threads(threads)
    body(omp_get_thread_num());
}

} // namespace carom
