#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// One of those who are compared by turns: it has so many equal steps before it, takes some of them when its
/// turn comes, and times them itself.
class Contender {
  public:
    virtual ~Contender() = default;

    virtual int steps() const = 0;

    /// Takes so many steps; returns the seconds that count.
    virtual double advance(int steps) = 0;
};

/// How many rounds there are, if a turn is to last `turn_seconds` on the median of the contenders and no turn
/// may be shorter than a step; at least one. `expected_seconds` are those of each contender's whole run.
int count_rounds(std::span<const double> expected_seconds, int fewest_steps, double turn_seconds);

/// All contenders advance from their first step to their last together: in each round each of them takes the
/// same share of its steps in one turn, and the order of turns is drawn anew. What disturbs the machine for
/// longer than a round disturbs all of them alike, so that ratios of their times are steadier than of runs
/// one after the other (paired benchmarking; for pairs of processes: Bulej and others, Duet benchmarking,
/// ICPE 2020). A turn begins with the caches as the contender before has left them.
///
/// Returns, for each contender, the seconds of each of its turns.
std::vector<std::vector<double>> take_turns(std::span<Contender* const> contenders, int rounds,
                                            std::uint64_t seed);

} // namespace carom
