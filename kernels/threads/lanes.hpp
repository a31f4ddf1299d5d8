#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "own_lines.hpp"

namespace carom {

/// Turns to be taken by several threads, each from a lane of its own first and from the others' when its own
/// cannot go on. So a number is taken from a counter that nobody else writes, and looks at, but for who has
/// nothing else to do. (So Box2D 3 hands out its blocks: solver.c, GetWorkerStartIndex.)
///
/// Each lane's turns come one after another, and none is taken before it can begin. Let every turn wait only
/// for turns of a lower rank, and rank never fall along a lane. Then as long as turns are left some thread
/// can take one or is at one: of those of the lowest rank that are not done each can begin, and so can what
/// stands before it in its lane. `Counter` is for tests, which count what is done to it.
template <class Turn, class Counter = std::atomic<int>> class Lanes {
  public:
    /// Room for so many lanes and turns.
    Lanes(int lanes, std::size_t turns) {
        lanes_.reserve(static_cast<std::size_t>(lanes));
        turns_.reserve(turns);
    }

    /// One turn more at the end of the last lane.
    void add(const Turn& turn) { turns_.push_back(turn); }

    /// Ends the last lane: what is added now is in the next one.
    void end_lane() {
        lanes_.emplace_back(static_cast<int>(turns_.size()), lanes_.empty() ? 0 : lanes_.back().end);
    }

    int lanes() const { return static_cast<int>(lanes_.size()); }
    std::span<const Turn> turns() const { return turns_; }

    /// The turns of one lane.
    std::span<const Turn> turns(int lane) const {
        const int begin = lane == 0 ? 0 : lanes_[static_cast<std::size_t>(lane) - 1].end;
        const int end = lanes_[static_cast<std::size_t>(lane)].end;
        return turns().subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
    }

    /// The number, in turns(), of one that was taken. Below 0: none that is left can begin, or none is left.
    static constexpr int wait = -1;
    static constexpr int done = -2;

    /// Takes the next turn of one lane, if it can begin.
    template <class CanBegin> int take_from(int lane, const CanBegin& can_begin) {
        Lane& one = lanes_[static_cast<std::size_t>(lane)];
        int turn = one.next.load(std::memory_order_relaxed);
        while (turn < one.end) {
            if (!can_begin(turns_[static_cast<std::size_t>(turn)])) {
                return wait;
            }
            if (one.next.compare_exchange_weak(turn, turn + 1, std::memory_order_relaxed)) {
                return turn;
            }
        }
        return done;
    }

    /// Takes the next turn that can begin of the lanes from that one on, all around.
    template <class CanBegin> int take(int first, const CanBegin& can_begin) {
        int outcome = done;
        for (int k = 0; k < lanes(); ++k) {
            const int lane = (first + k) % lanes();
            const int turn = take_from(lane, can_begin);
            if (turn >= 0) {
                return turn;
            }
            outcome = std::max(outcome, turn);
        }
        return outcome;
    }

  private:
    struct alignas(cache_line) Lane {
        Lane(int its_end, int begin) : end(its_end), next(begin) {}
        Lane(const Lane& other) : end(other.end), next(other.next.load(std::memory_order_relaxed)) {}
        Lane& operator=(const Lane&) = delete;
        ~Lane() = default;

        int end; ///< of its turns
        Counter next;
    };

    std::vector<Lane> lanes_;
    std::vector<Turn> turns_;
};

} // namespace carom
