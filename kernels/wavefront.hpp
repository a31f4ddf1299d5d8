#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
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
// beside each other take the same order as in `strips`, others share nothing (sweep.hpp,
// resolve_contacts.hpp), and the result is the same to the last bit.
//
// Whether a sweep was the last can be told only when all strips have been through it. Meanwhile some begin
// with the next: it changes nothing then, and does not count.

namespace carom {

/// A strip in a sweep.
struct StripSweep {
    int strip;
    int sweep;
};

/// The order of some sweeps over all strips, each after those that it waits for. They are taken by groups of
/// `pairs_at_once` pairs, of an even strip and the odd one before it: the even strips of a group, then the
/// odd ones.
///
/// One group that holds all goes through one sweep after the other. Of several, each sweep follows two groups
/// behind the one before it (the odd strip that a group's last even one waits for is in the next group), so
/// that what one sweep has brought into the cache the next ones find there. (Time skewing: McCalpin and
/// Wonnacott, Rutgers DCS-TR-379, 1999.)
inline std::vector<StripSweep> sweep_order(int strips, int sweeps, int pairs_at_once) {
    std::vector<StripSweep> order;
    order.reserve(static_cast<std::size_t>(strips) * static_cast<std::size_t>(sweeps));
    const int groups = strips / 2 / pairs_at_once + 1;
    for (int stage = 0; stage < groups + 2 * (sweeps - 1); ++stage) {
        for (int odd = 0; odd < 2; ++odd) {
            for (int sweep = 0; sweep < sweeps; ++sweep) {
                const int group = stage - 2 * sweep;
                const int end = std::min((group + 1) * pairs_at_once, (strips + odd + 1) / 2);
                for (int pair = std::max(group * pairs_at_once, odd); pair < end; ++pair) {
                    order.push_back({2 * pair - odd, sweep});
                }
            }
        }
    }
    return order;
}

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

/// Does a sweep touch more memory than it finds in the cache the next time?
template <Policies policies> bool exceeds_cache(const State<policies>& state, const Tuning& tuning) {
    if constexpr (policies.overlaps != Overlaps::contacts || policies.worklist != Worklist::active) {
        return false;
    } else {
        std::size_t bytes =
            state.discs.size() * (sizeof state.discs.front() + sizeof state.segments_of_disc.front());
        for (const auto& strip : state.strips) {
            bytes += strip.contacts.size() * sizeof strip.contacts.front();
        }
        return bytes > tuning.cache_bytes;
    }
}

/// The next sweeps after the first `done` ones, `most` at most: each as one of `strips`, up to the first that
/// changes nothing. On one thread one sweep, elsewhere twice as many each time, so that few are run in vain.
/// `skewed`: as many as may be, a few strips behind each other.
template <Policies policies, class SomeProbe>
Swept sweep_wavefront(State<policies>& state, Wavefront& wavefront, int done, int most, bool skewed,
                      const Tuning& tuning, const ApproachToleranceOf<policies>& approaching,
                      SomeProbe& probe) {
    const int wanted = skewed ? most_sweeps_at_once : tuning.threads == 1 ? 1 : done + 1;
    const int count = std::min({wanted, most, most_sweeps_at_once});
    assert(count > 0);
    const int strips = state.grid.strip_count(strip_height(policies.order));
    const std::vector<StripSweep> order =
        sweep_order(strips, count, skewed ? tuning.threads / 4 + 1 : strips);
    std::array<std::atomic<int>, most_sweeps_at_once> changes{};
    std::array<std::atomic<int>, most_sweeps_at_once> attempts{};
    const auto resolve_next = [&](int index) {
        const auto [strip, sweep] = order[static_cast<std::size_t>(index)];
        Changes made = resolve_strip(state, strip, approaching);
        attempts[static_cast<std::size_t>(sweep)].fetch_add(std::exchange(made.attempts, 0),
                                                            std::memory_order_relaxed);
        if (made.any()) {
            changes[static_cast<std::size_t>(sweep)].fetch_add(made.count(), std::memory_order_relaxed);
        }
        wavefront.ends(strip, done + sweep);
        return Tally(made);
    };
    Swept swept;
    swept.work =
        parallel_for<policies.resolve_schedule>(tuning.threads, static_cast<int>(order.size()),
                                                tuning.resolve_chunk, probe, resolve_next, [&](int index) {
                                                    const auto [strip, sweep] =
                                                        order[static_cast<std::size_t>(index)];
                                                    return wavefront.can_begin(strip, done + sweep);
                                                });
    const auto last = std::find(changes.begin(), changes.begin() + count - 1, 0);
    swept.work.sweeps = last - changes.begin() + 1;
    // Of those that were run in vain, whose number depends on that of the threads, nothing is counted.
    swept.work.pair_attempts =
        std::accumulate(attempts.begin(), attempts.begin() + swept.work.sweeps, std::int64_t{0});
    swept.last_changes = *last;
    return swept;
}

} // namespace carom
