#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "parallel_for.hpp"
#include "policies.hpp"
#include "resolve_contacts.hpp"
#include "resolve_lists.hpp"
#include "state.hpp"
#include "sweep.hpp"
#include "tally.hpp"

// The sweeps of `strips` without its barriers. There a strip waits twice a sweep for all others, though it
// shares discs and marks only with those beside it. Here it waits for these alone: an even strip until both
// have been through the sweep before, an odd one until both have been through this one. So any two strips
// beside each other take the same turns as in `strips`, others share nothing (sweep.hpp,
// resolve_contacts.hpp), and the result is the same to the last bit.
//
// Whether a sweep was the last can be told only when all strips have been through it. Meanwhile some begin
// with the next: it changes nothing then, and does not count.

namespace carom {

/// The turns of some sweeps over strips, in each the even ones first.
struct StripTurns {
    int strips;

    explicit StripTurns(int its_strips) : strips(its_strips) {}

    int sweep(int turn) const { return turn / strips; }
    int strip(int turn) const {
        const int even = every_other(strips, 0);
        const int k = turn % strips;
        return k < even ? 2 * k : 2 * (k - even) + 1;
    }
};

/// How far each strip has come in the resolve of one step.
class Wavefront {
  public:
    explicit Wavefront(int strips) : strips_(static_cast<std::size_t>(strips)) {}

    /// Can that strip begin with that sweep? If so, what the strips beside it wrote before is seen.
    bool can_begin(int strip, int sweep) const {
        const int before = sweep + strip % 2;
        return swept(strip - 1, before) && swept(strip, sweep) && swept(strip + 1, before);
    }

    void ends(int strip, int sweep) {
        strips_[static_cast<std::size_t>(strip)].sweeps.store(sweep + 1, std::memory_order_release);
    }

  private:
    /// Apart from the others', so that no store disturbs who waits for another strip.
    struct alignas(cache_line) Progress {
        std::atomic<int> sweeps = 0;
    };

    /// Has that strip, if there is one, been through that many sweeps?
    bool swept(int strip, int sweeps) const {
        return strip < 0 || strip >= static_cast<int>(strips_.size()) ||
               strips_[static_cast<std::size_t>(strip)].sweeps.load(std::memory_order_acquire) >= sweeps;
    }

    std::vector<Progress> strips_;
};

/// So many sweeps at most run as one.
inline constexpr int most_sweeps_at_once = 8;

/// The next sweeps after the first `done` ones, `most` at most: each as one of `strips`, up to the first that
/// changes nothing. On one thread one sweep, elsewhere twice as many each time, so that few are run in vain.
template <Policies policies, class SomeProbe>
Swept sweep_wavefront(State<policies>& state, Wavefront& wavefront, int done, int most, const Tuning& tuning,
                      const ApproachToleranceOf<policies>& approaching, SomeProbe& probe) {
    const int count = tuning.threads == 1 ? 1 : std::min({done + 1, most, most_sweeps_at_once});
    const StripTurns turns(state.grid.strip_count(strip_height(policies.order)));
    const auto sweep_of = [=](int turn) { return turns.sweep(turn); };
    const auto strip_of = [=](int turn) { return turns.strip(turn); };
    std::array<std::atomic<int>, most_sweeps_at_once> changes{};
    std::array<std::atomic<int>, most_sweeps_at_once> attempts{};
    const auto resolve_turn = [&](int turn) {
        Changes made = resolve_strip(state, strip_of(turn), approaching);
        attempts[static_cast<std::size_t>(sweep_of(turn))].fetch_add(std::exchange(made.attempts, 0),
                                                                     std::memory_order_relaxed);
        if (made.any()) {
            changes[static_cast<std::size_t>(sweep_of(turn))].fetch_add(made.count(),
                                                                        std::memory_order_relaxed);
        }
        wavefront.ends(strip_of(turn), done + sweep_of(turn));
        return Tally(made);
    };
    Swept swept;
    swept.work = parallel_for<policies.resolve_schedule>(
        tuning.threads, count * turns.strips, tuning.resolve_chunk, probe, resolve_turn,
        [&](int turn) { return wavefront.can_begin(strip_of(turn), done + sweep_of(turn)); });
    const auto last = std::find(changes.begin(), changes.begin() + count - 1, 0);
    swept.work.sweeps = last - changes.begin() + 1;
    // Of those that were run in vain, whose number depends on that of the threads, nothing is counted.
    swept.work.pair_attempts =
        std::accumulate(attempts.begin(), attempts.begin() + swept.work.sweeps, std::int64_t{0});
    swept.last_changes = *last;
    return swept;
}

} // namespace carom
