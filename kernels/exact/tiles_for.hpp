#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "kernels/exact/tile_grid.hpp"

namespace carom {

/// The work of the thread that has most of it in a window, in discs in one piece: each has as many tiles as
/// any other or one less. A tile simulates its copies, too, compares and remembers, and whatever it has must
/// be put right between windows. The figures are of two cores (docs/notebook/2026-11-27-exact.md).
inline double work_in_tiles(double discs, const TileCounts& tiles, int threads) {
    constexpr double halo = 6;        // is so wide, in mean distances between discs
    constexpr double comparing = 1.1; // takes so many times the work,
    constexpr double window = 450;    // and what is between windows that of so many discs
    if (tiles.all() == 1) {
        return discs;
    }
    const auto side = [&](int count) { return std::sqrt(discs) / count + halo * std::min(count - 1, 2); };
    const double rounds = std::ceil(static_cast<double>(tiles.all()) / threads);
    return rounds * (comparing * side(tiles.columns) * side(tiles.rows) + window);
}

/// Into how many tiles a scene of so many discs is cut for that many threads: those with the least work, or
/// one where more gain little. A scene far larger than a cache is cut into tiles that fit one, on one thread,
/// too.
inline TileCounts tiles_for(std::size_t discs, int threads) {
    constexpr double least_discs = 1'000;   // of a tile
    constexpr double cached_discs = 63'000; // with all that belongs to them some 15 MB
    constexpr double beyond_cache = 400'000;
    constexpr double least_gain = 1.2;
    const auto count = static_cast<double>(discs);
    const double fewest = count >= beyond_cache ? count / cached_discs : 1;
    const double most = count / least_discs;
    // Of tiles in a row: a number of threads without divisors near its root is served by longer rows.
    const int longest = 2 * static_cast<int>(std::ceil(std::sqrt(std::max<double>(fewest, threads))));
    TileCounts best;
    double least = fewest > 1 ? std::numeric_limits<double>::infinity() : count / least_gain;
    for (int columns = 1; columns <= longest; ++columns) {
        for (int rows = 1; rows <= columns; ++rows) {
            const TileCounts tiles{.columns = columns, .rows = rows};
            const double work = work_in_tiles(count, tiles, threads);
            if (tiles.all() > 1 && tiles.all() >= fewest - 0.5 && tiles.all() <= most && work < least) {
                best = tiles;
                least = work;
            }
        }
    }
    return best;
}

} // namespace carom
