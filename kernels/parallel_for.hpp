#pragma once

#include <cassert>
#include <cstddef>
#include <type_traits>

#include <omp.h>
#include <sched.h>

#include "policies.hpp"
#include "probe.hpp"
#include "threads/lanes.hpp"

// Every OpenMP pragma of the project stands in this file.

namespace carom {

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

/// After the `asked`-th look.
inline void pause_between_looks(int asked) {
    relax();
    if (asked % patience == 0) {
        sched_yield();
    }
}

/// Waits until `ready(i)`.
template <class SomeProbe, class Ready> void await(int i, const Ready& ready, int thread, SomeProbe& probe) {
    probe.wait_begin(thread);
    for (int asked = 1; !ready(i); ++asked) {
        pause_between_looks(asked);
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

/// Who waits looks into its own lane alone so often before it looks into all: each look into another one's
/// makes that one's next turn dearer.
inline constexpr int looks_at_own_lane = 16;

/// The next turn for a thread, which it may wait for; below 0: none is left.
template <class Turn, class SomeProbe, class Ready>
int next_turn(Lanes<Turn>& lanes, int thread, const Ready& ready, SomeProbe& probe) {
    const int own = thread % lanes.lanes();
    int turn = lanes.take(own, ready);
    if (turn != Lanes<Turn>::wait) {
        return turn;
    }
    probe.wait_begin(thread);
    for (int asked = 1; turn == Lanes<Turn>::wait; ++asked) {
        pause_between_looks(asked);
        turn = asked % looks_at_own_lane == 0 ? lanes.take(own, ready) : lanes.take_from(own, ready);
        turn = turn == Lanes<Turn>::done ? lanes.take(own, ready) : turn;
    }
    probe.wait_end(thread);
    return turn;
}

/// Runs `body(turn)` for each turn of all lanes on `threads` threads, as they come (threads/lanes.hpp), and
/// returns the sum of what the bodies return. A turn begins when `ready(turn)` is true, which turns before it
/// make it. Exceptions must not leave `body`.
template <class Turn, class SomeProbe, class Body, class Ready>
auto take_turns(int threads, Lanes<Turn>& lanes, SomeProbe& probe, const Body& body, const Ready& ready) {
    // A region of its own: where the two share one, g++ 12 makes 2 % more instructions of the loops over
    // boxes.
    using Sum = std::invoke_result_t<const Body&, const Turn&>;
    Sum total;
#pragma omp declare reduction(add:Sum : omp_out += omp_in)
#pragma omp parallel num_threads(threads) reduction(add : total)
    {
        Sum sum;
        const int thread = omp_get_thread_num();
        probe.loop_begin(thread);
        for (int turn = next_turn(lanes, thread, ready, probe); turn >= 0;
             turn = next_turn(lanes, thread, ready, probe)) {
            probe.iteration(thread, turn);
            sum += body(lanes.turns()[static_cast<std::size_t>(turn)]);
        }
        probe.loop_end(thread);
        if constexpr (!std::is_same_v<SomeProbe, NoProbe>) {
#pragma omp barrier
            probe.barrier_end(thread);
        }
        total += sum;
    }
    return total;
}

/// Runs `body(thread)` once on each of the same threads that `parallel_for` with as many threads uses.
template <class Body> void on_each_thread(int threads, const Body& body) {
#pragma omp parallel num_threads(threads)
    body(omp_get_thread_num());
}

} // namespace carom
