#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/tally.hpp"
#include "kernels/threads/lanes.hpp"
#include "kernels/wavefront.hpp"

namespace carom {
namespace {

/// What a turn waits for has a lower rank.
int rank(StripSweep turn) { return 2 * turn.sweep + turn.strip % 2; }

void expect_all_once(const Lanes<StripSweep>& lanes, int strips, int sweeps) {
    std::vector<int> times(static_cast<std::size_t>(strips * sweeps));
    for (const StripSweep turn : lanes.turns()) {
        ++times.at(static_cast<std::size_t>(turn.sweep * strips + turn.strip));
    }
    EXPECT_TRUE(std::ranges::all_of(times, [](int n) { return n == 1; }));
}

TEST(LanesOfNeighbours, HaveAllTurnsByRank) {
    for (const int strips : {1, 2, 3, 9, 24, 31}) {
        for (const int sweeps : {1, 2, 8}) {
            for (const int threads : {1, 2, 3, 12, 64}) {
                const auto lanes = lanes_of_neighbours(strips, sweeps, threads);
                SCOPED_TRACE(testing::Message() << strips << ", " << sweeps << ", " << threads);
                expect_all_once(lanes, strips, sweeps);
                EXPECT_LE(lanes.lanes(), threads);
                for (int lane = 0; lane < lanes.lanes(); ++lane) {
                    EXPECT_TRUE(std::ranges::is_sorted(lanes.turns(lane), {}, rank)) << lane;
                    EXPECT_FALSE(lanes.turns(lane).empty());
                }
            }
        }
    }
}

TEST(LanesInTurns, HaveAllTurnsInTheirOrder) {
    for (const int threads : {1, 2, 3, 64}) {
        const auto order = sweep_order(31, 8, threads / 4 + 1);
        const auto lanes = lanes_in_turns(order, threads);
        expect_all_once(lanes, 31, 8);
        EXPECT_EQ(lanes.lanes(), threads);
        for (int lane = 0; lane < threads; ++lane) {
            for (std::size_t k = 0; k < lanes.turns(lane).size(); ++k) {
                const StripSweep expected =
                    order[k * static_cast<std::size_t>(threads) + static_cast<std::size_t>(lane)];
                EXPECT_EQ(lanes.turns(lane)[k].strip, expected.strip);
                EXPECT_EQ(lanes.turns(lane)[k].sweep, expected.sweep);
            }
        }
    }
}

TEST(LanesInTurns, EndWhicheverThreadGoesOn) {
    for (const int goes_on : {0, 3, 6}) {
        Wavefront wavefront(31);
        auto lanes = lanes_in_turns(sweep_order(31, 8, 2), 7);
        const auto can_begin = [&](StripSweep turn) { return wavefront.can_begin(turn.strip, turn.sweep); };
        int taken = 0;
        for (int turn = lanes.take(goes_on, can_begin); turn >= 0; turn = lanes.take(goes_on, can_begin)) {
            const auto [strip, sweep] = lanes.turns()[static_cast<std::size_t>(turn)];
            wavefront.ends(strip, sweep);
            ++taken;
        }
        EXPECT_EQ(taken, 31 * 8);
        EXPECT_EQ(lanes.take(0, can_begin), Lanes<StripSweep>::done);
    }
}

/// A counter that knows who changes it.
class Counted {
  public:
    static inline int thread = 0;  ///< who does what follows
    static inline int changes = 0; ///< of all counters
    static inline int handed = 0;  ///< changes by another thread than the last one
    static void forget() { changes = handed = 0; }

    Counted(int value) : value_(value) {}

    int load(std::memory_order /*order*/) const { return value_; }
    bool compare_exchange_weak(int& expected, int desired, std::memory_order /*order*/) {
        ++changes;
        handed += last_ >= 0 && last_ != thread ? 1 : 0;
        last_ = thread;
        const bool same = value_ == expected;
        expected = std::exchange(value_, same ? desired : value_);
        return same;
    }

  private:
    int value_;
    int last_ = -1;
};

/// Lets so many threads, one turn at a time each, take all turns; returns how often one found none.
int take_all(int strips, int sweeps, int threads) {
    const auto dealt = lanes_of_neighbours(strips, sweeps, threads);
    Lanes<StripSweep, Counted> lanes(dealt.lanes(), dealt.turns().size());
    for (int lane = 0; lane < dealt.lanes(); ++lane) {
        for (const StripSweep turn : dealt.turns(lane)) {
            lanes.add(turn);
        }
        lanes.end_lane();
    }
    Counted::forget();
    Wavefront wavefront(strips);
    const auto can_begin = [&](StripSweep turn) { return wavefront.can_begin(turn.strip, turn.sweep); };
    int waits = 0;
    for (std::vector<int> at(static_cast<std::size_t>(threads)); !at.empty();) {
        at.clear();
        for (Counted::thread = 0; Counted::thread < threads; ++Counted::thread) {
            const int turn = lanes.take(Counted::thread % lanes.lanes(), can_begin);
            waits += turn == Lanes<StripSweep>::wait ? 1 : 0;
            if (turn >= 0) {
                at.push_back(turn);
            }
        }
        for (const int turn : at) {
            const auto [strip, sweep] = lanes.turns()[static_cast<std::size_t>(turn)];
            wavefront.ends(strip, sweep);
        }
    }
    return waits;
}

/// Before there were lanes, each turn changed three counters that all threads share.
TEST(LanesOfNeighbours, TakeOneChangeATurnOfACounterThatNobodyElseChanges) {
    for (const int threads : {1, 2, 3, 4, 13}) {
        const int waits = take_all(78, 8, threads);
        EXPECT_EQ(Counted::changes, 78 * 8) << threads;
        EXPECT_LE(Counted::handed, 78 * 8 / 10) << threads;
        EXPECT_LE(waits, 78 * 8 / 10) << threads;
    }
    take_all(80, 8, 4); // twenty strips each
    EXPECT_EQ(Counted::handed, 0);
}

TEST(LanesOfNeighbours, EndWithMoreThreadsThanStrips) {
    take_all(24, 8, 64);
    EXPECT_EQ(Counted::changes, 24 * 8);
}

TEST(Wavefront, AddsUpMoreThanAnIntHolds) {
    constexpr int most = std::numeric_limits<int>::max();
    constexpr int strips = 2500; // of a hundred million discs
    Wavefront wavefront(strips);
    for (int strip = 0; strip < strips; ++strip) {
        wavefront.notes(strip, 3, {.pair_resolves = most, .pair_attempts = std::int64_t{4} * most});
    }
    EXPECT_EQ(wavefront.noted(3).changes, std::int64_t{strips} * most);
    EXPECT_EQ(wavefront.noted(3).attempts, std::int64_t{strips} * 4 * most);
    EXPECT_EQ(wavefront.noted(2).attempts, 0);
}

} // namespace
} // namespace carom
