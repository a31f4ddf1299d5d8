#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace carom {

/// What a turn took.
struct TurnTime {
    int place = 0; ///< among all turns of all contenders, in the order of time, from 0
    int steps = 0;
    double seconds = 0; ///< that count

    /// Those of its first step, which finds the caches as the contender before has left them; empty if the
    /// turn is one step.
    std::optional<double> returning_seconds;
};

/// One of those who are compared by turns: it has so many equal steps before it, takes some of them when its
/// turn comes, and times them itself. It can be run from the first step to the last again and again.
class Contender {
  public:
    virtual ~Contender() = default;

    virtual int steps() const = 0;

    /// Goes back to the first step; the run before, if there was one, has ended.
    virtual void start() = 0;

    virtual TurnTime advance(int steps) = 0;
};

/// How often they run, in how many rounds of turns each time, and what draws the order of the turns.
struct TurnsPlan {
    int runs = 1;
    int rounds = 1; ///< of one run
    std::uint64_t seed = 1;
};

/// How many rounds there are, if a turn is to last `turn_seconds` on the median of the contenders and no turn
/// may be shorter than two steps, a first one that finds other caches and one that does not; at least one.
/// `expected_seconds` are those of each contender's whole run.
int count_rounds(std::span<const double> expected_seconds, int fewest_steps, double turn_seconds);

/// All contenders advance from their first step to their last together: in each round each of them takes the
/// same share of its steps in one turn, and the order of turns is drawn anew. What disturbs the machine for
/// longer than a round disturbs all of them alike, so that ratios of their times are steadier than of runs
/// one after the other (paired benchmarking; for pairs of processes: Bulej and others, Duet benchmarking,
/// ICPE 2020). A turn begins with the caches as the contender before has left them. When all have come to
/// their last step, all start again together, as often as there are runs.
///
/// Where turns are of two steps or more, every second run, and the first one of every odd seed, begins with
/// half a turn: a step that is the first of its turn here is none there. What first steps lose is then no
/// matter of which steps have more work.
///
/// Returns, for each contender, each of its turns, run by run.
std::vector<std::vector<TurnTime>> take_turns(std::span<Contender* const> contenders, const TurnsPlan& plan);

} // namespace carom
