#pragma once

#include <cstdint>

namespace carom {

/// What one step did.
struct Tally {
    std::int64_t overlaps = 0;      ///< overlapping pairs, each counted once
    std::int64_t pair_resolves = 0; ///< pairs whose velocities were changed
    std::int64_t pair_attempts = 0; ///< overlapping pairs, or contacts, asked whether they collide
    std::int64_t wall_resolves = 0; ///< velocity components turned by a wall
    std::int64_t sweeps = 0;        ///< sweeps of the resolve, the last, which changes nothing, included
    bool settled = true;            ///< false: the sweep limit was reached with something still colliding

    bool changed() const { return pair_resolves + wall_resolves > 0; }

    Tally& operator+=(const Tally& other) {
        overlaps += other.overlaps;
        pair_resolves += other.pair_resolves;
        pair_attempts += other.pair_attempts;
        wall_resolves += other.wall_resolves;
        sweeps += other.sweeps;
        settled = settled && other.settled;
        return *this;
    }
    friend bool operator==(const Tally&, const Tally&) = default;
};

/// What visiting a disc, or those of a box or a strip, or its contacts, changed. An int holds that unless
/// there are some gigabytes of lists in one strip; of all discs it is a Tally.
struct Changes {
    int pairs = 0;
    int walls = 0;
    int attempts = 0; ///< pairs asked, changed or not

    int count() const { return pairs + walls; }
    bool any() const { return count() > 0; }
    Changes& operator+=(const Changes& other) {
        pairs += other.pairs;
        walls += other.walls;
        attempts += other.attempts;
        return *this;
    }
    operator Tally() const {
        return {.pair_resolves = pairs, .pair_attempts = attempts, .wall_resolves = walls};
    }
};

} // namespace carom
