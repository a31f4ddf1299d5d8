#pragma once

#include <cstdint>
#include <vector>

#include "harness/scenes/random_numbers.hpp"

namespace carom {

/// Where the generator puts the discs.
enum class Placement {
    overlapping, ///< uniform in the box, overlapping or not: the published way
    random,      ///< one by one at random where it overlaps none of those before
    lattice,     ///< on a jittered hexagonal lattice, none overlapping
};

/// `count` centres by random sequential addition: uniform in [r, L - r)^2, kept if at more than 2r from those
/// kept before. No disc overlaps another or a wall.
///
/// The process jams at an area fraction of 0.5470735 in an infinite box (Zhang and Torquato, Phys. Rev. E 88,
/// 053312, 2013) and gets there as the square root of the number of trials (Feder, J. Theor. Biol. 87, 237,
/// 1980). It is given up after `trials_per_disc` trials for each disc. Throws InputError with the area
/// fraction reached if not all discs found a place.
std::vector<Point> random_sequential_centres(int count, double side, double radius, RandomNumbers& random,
                                             std::int64_t trials_per_disc = 1000);

/// `count` centres on a hexagonal lattice that fills the box, each moved at random within a circle as wide as
/// the gap between neighbours allows. No disc overlaps another or a wall; vacant sites are spread evenly.
/// Throws InputError with the largest number of discs that fit if these do not.
std::vector<Point> lattice_centres(int count, double side, double radius, RandomNumbers& random);

} // namespace carom
