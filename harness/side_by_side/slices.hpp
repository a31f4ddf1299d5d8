#pragma once

#include <cstdint>
#include <vector>

#include "harness/processes/process.hpp"

namespace carom {

/// A process that takes turns with others.
struct Sliced {
    Process* process;
    double expected_seconds = 0; ///< how long it takes undisturbed, or 0 where nobody knows
    double seconds_alone = 0;    ///< told afterwards: what of it ran after all others had ended
};

/// How long the slices of each are, in seconds.
///
/// Those of the one that takes shortest are `slice_seconds`, or all that it takes, and those of the others
/// longer in proportion, so that all end together: what ran alone would be compared with another time of the
/// machine. Where nobody knows how long one takes all have slices alike.
std::vector<double> lengths_of_slices(const std::vector<Sliced>& all, double slice_seconds);

/// Runs all of them to their ends in turn: in each round, in an order that is drawn anew, each of those that
/// have not ended runs for a slice of time, while the others stand still.
///
/// Slices are as long as `lengths_of_slices` has them, and all longer alike where it takes more than a tenth
/// of them until a program is known to stand still; the last one left is not stopped any more. What
/// disturbs the machine for longer than a round disturbs all alike (as in turns.hpp). A process notices
/// nothing but that the clock on the wall runs faster than its own work.
void take_slices(std::vector<Sliced>& all, double slice_seconds, std::uint64_t seed);

} // namespace carom
