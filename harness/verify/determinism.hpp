#pragma once

#include "kernels/policies.hpp"

namespace carom {

/// Over what the final state of a variant is promised to be the same, to the last bit.
struct Determinism {
    bool threads = false;   ///< any number of threads, any schedule and any chunk
    bool compilers = false; ///< any compiler that contracts no multiplications and additions
};

/// What is promised of a combination of policies, and tested of every variant.
///
/// Threads: the sequential orders resolve on one thread; in the parallel ones no two iterations of a loop
/// touch one disc (the proof is in kernels/sweep.hpp), and the lists of overlaps do not depend on who finds
/// them. Compilers: every operation is one of IEEE 754's, which rounds in one way only, in an order that the
/// source fixes.
constexpr Determinism promised(const Policies& /*policies*/) { return {.threads = true, .compilers = true}; }

} // namespace carom
