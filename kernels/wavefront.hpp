#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "parallel_for.hpp"
#include "policies.hpp"
#include "resolve_contacts.hpp"
#include "resolve_lists.hpp"
#include "state.hpp"
#include "sweep.hpp"
#include "tally.hpp"
#include "threads/lanes.hpp"
#include "threads/own_lines.hpp"

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

/// So many sweeps at most run as one.
inline constexpr int most_sweeps_at_once = 8;

/// How far each strip has come in the resolve of one step, and what it did in the sweeps that run as one.
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

    /// Notes what a strip has done in the `sweep`-th of the sweeps that run as one.
    void notes(int strip, int sweep, const Tally& made) {
        Strip& one = strips_[static_cast<std::size_t>(strip)];
        one.changes[static_cast<std::size_t>(sweep)] = made.pair_resolves + made.wall_resolves;
        one.attempts[static_cast<std::size_t>(sweep)] = made.pair_attempts;
    }

    /// What all strips have noted of that sweep.
    struct Noted {
        std::int64_t changes = 0;
        std::int64_t attempts = 0;
    };
    Noted noted(int sweep) const {
        Noted all;
        for (const Strip& one : strips_) {
            all.changes += one.changes[static_cast<std::size_t>(sweep)];
            all.attempts += one.attempts[static_cast<std::size_t>(sweep)];
        }
        return all;
    }

  private:
    /// Apart from the others', so that no store disturbs who waits for another strip. A strip is in one
    /// thread's hands at a time.
    struct alignas(cache_line) Strip {
        std::atomic<int> sweeps = 0;
        std::array<std::int64_t, most_sweeps_at_once> changes{};
        std::array<std::int64_t, most_sweeps_at_once> attempts{};
    };

    /// Has that strip, if there is one, been through that many sweeps?
    bool swept(int strip, int sweeps) const {
        return strip < 0 || strip >= static_cast<int>(strips_.size()) ||
               strips_[static_cast<std::size_t>(strip)].sweeps.load(std::memory_order_acquire) >= sweeps;
    }

    std::vector<Strip> strips_;
};

/// Who takes which turns first, by an order in which sweeps follow close behind each other: in turns, so that
/// all go through it together.
inline Lanes<StripSweep> lanes_in_turns(const std::vector<StripSweep>& order, int threads) {
    Lanes<StripSweep> lanes(threads, order.size());
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(threads); ++lane) {
        for (std::size_t turn = lane; turn < order.size(); turn += static_cast<std::size_t>(threads)) {
            lanes.add(order[turn]);
        }
        lanes.end_lane();
    }
    return lanes;
}

/// The same of one sweep after the other: a lane has strips beside each other, for its thread to find them in
/// its cache. Every other lane goes through them backward, so that where two meet, both begin with those that
/// the other waits for, or both end with them, and there is half a sweep between.
inline Lanes<StripSweep> lanes_of_neighbours(int strips, int sweeps, int threads) {
    const int pairs = (strips + 1) / 2;
    const int count = std::clamp(pairs, 1, threads);
    Lanes<StripSweep> lanes(count, static_cast<std::size_t>(strips) * static_cast<std::size_t>(sweeps));
    for (int lane = 0; lane < count; ++lane) {
        const int first = pairs * lane / count;
        const int last = pairs * (lane + 1) / count - 1;
        for (int half = 0; half < 2 * sweeps; ++half) {
            for (int k = first; k <= last; ++k) {
                const int strip = 2 * (lane % 2 == 0 ? k : first + last - k) + half % 2;
                if (strip < strips) {
                    lanes.add({strip, half / 2});
                }
            }
        }
        lanes.end_lane();
    }
    return lanes;
}

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

/// Runs `body` for every strip in every one of some sweeps, each when it can begin, and returns the sum of
/// what the bodies return. With Schedule::dynamic threads take turns from lanes; the other schedules deal
/// them out. `skewed`: one sweep follows close behind the other.
template <Policies policies, class SomeProbe, class Body, class CanBegin>
Tally sweep_in_turns(int strips, int sweeps, bool skewed, const Tuning& tuning, SomeProbe& probe,
                     const Body& body, const CanBegin& can_begin) {
    const auto order = [&] { return sweep_order(strips, sweeps, skewed ? tuning.threads / 4 + 1 : strips); };
    if constexpr (policies.resolve_schedule == Schedule::dynamic) {
        Lanes<StripSweep> lanes = skewed ? lanes_in_turns(order(), tuning.threads)
                                         : lanes_of_neighbours(strips, sweeps, tuning.threads);
        return take_turns(tuning.threads, lanes, probe, body, can_begin);
    } else {
        const std::vector<StripSweep> turns = order();
        const auto turn = [&turns](int index) { return turns[static_cast<std::size_t>(index)]; };
        return parallel_for<policies.resolve_schedule>(
            tuning.threads, static_cast<int>(turns.size()), tuning.resolve_chunk, probe,
            [&](int index) { return body(turn(index)); }, [&](int index) { return can_begin(turn(index)); });
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
    const auto resolve_next = [&](const StripSweep& next) {
        const Tally made = resolve_strip(state, next.strip, approaching);
        wavefront.notes(next.strip, next.sweep, made);
        wavefront.ends(next.strip, done + next.sweep);
        return made;
    };
    const auto can_begin = [&](const StripSweep& next) {
        return wavefront.can_begin(next.strip, done + next.sweep);
    };
    Swept swept;
    swept.work = sweep_in_turns<policies>(strips, count, skewed, tuning, probe, resolve_next, can_begin);
    // Of those that were run in vain, whose number depends on that of the threads, nothing is counted.
    swept.work.pair_attempts = 0;
    do {
        const Wavefront::Noted noted = wavefront.noted(static_cast<int>(swept.work.sweeps++));
        swept.work.pair_attempts += noted.attempts;
        swept.last_changes = noted.changes;
    } while (swept.last_changes > 0 && swept.work.sweeps < count);
    return swept;
}

} // namespace carom
