#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <queue>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "kernels/exact/tile_history.hpp"
#include "kernels/probe.hpp"

namespace carom {

/// The collisions that the tiles of a window have listed, in the order in which one queue of all discs has
/// them: by time, and of one instant always that of the lowest numbers among those that are the next one of
/// both their discs. A collision of two tiles is in the lists of both.
template <class Real> class CollisionsInOrder {
  public:
    /// Of that tile.
    void add(int tile, const TileHistory<Real>& history) {
        for (const Listed& one : history.collisions()) {
            all_.push_back({tile, &one});
        }
    }

    /// `log` is told all of them.
    template <class Log> void tell(Log& log) {
        const auto time = [](const Of& one) { return one.listed->collision.time; };
        std::ranges::stable_sort(all_, {}, time);
        for (auto begin = all_.begin(); begin != all_.end();) {
            const auto end = std::ranges::find_if(begin, all_.end(),
                                                  [&](const Of& one) { return time(one) != time(*begin); });
            tell_instant(std::span(begin, end), log);
            begin = end;
        }
        all_.clear();
    }

  private:
    using Listed = typename TileHistory<Real>::Listed;

    struct Of {
        int tile;
        const Listed* listed;
    };

    /// A collision: its discs, and the how manieth of them at that instant.
    using Name = std::tuple<int, int, int>;

    struct Waiting {
        const Collision<Real>* collision = nullptr;
        int before = 0; ///< so many must be told first
        std::vector<Name> after;
    };

    template <class Log> void tell_instant(std::span<const Of> listed, Log& log) {
        if (listed.size() == 1) {
            log.collided(listed.front().listed->collision);
            return;
        }
        std::map<Name, Waiting> waiting = in_turn_of_discs(listed);
        std::priority_queue<Name, std::vector<Name>, std::greater<>> next;
        for (const auto& [name, one] : waiting) {
            if (one.before == 0) {
                next.push(name);
            }
        }
        while (!next.empty()) {
            const Waiting& one = waiting.at(next.top());
            next.pop();
            log.collided(*one.collision);
            for (const Name& after : one.after) {
                if (--waiting.at(after).before == 0) {
                    next.push(after);
                }
            }
        }
    }

    /// Each collision waits for the one before it of each of its discs, at the owner's.
    std::map<Name, Waiting> in_turn_of_discs(std::span<const Of> listed) {
        std::map<Name, Waiting> waiting;
        std::map<std::tuple<int, int, int>, int> times; // of a tile and two discs
        std::map<int, Name> last;                       // of each disc
        for (const auto& [tile, one] : listed) {
            const Collision<Real>& collision = one->collision;
            const Name name{collision.first, collision.second,
                            times[{tile, collision.first, collision.second}]++};
            waiting[name].collision = &collision;
            const auto take_turn = [&](int disc) {
                if (const auto before = last.find(disc); before != last.end()) {
                    waiting[before->second].after.push_back(name);
                    ++waiting[name].before;
                }
                last.insert_or_assign(disc, name);
            };
            if (one->owns_first) {
                take_turn(collision.first);
            }
            if (one->owns_second && !collision.at_wall()) {
                take_turn(collision.second);
            }
        }
        return waiting;
    }

    std::vector<Of> all_;
};

} // namespace carom
