#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "kernels/exact/flight.hpp"
#include "kernels/exact/rectangle.hpp"

namespace carom {

/// Where a disc is at a time from its last collision on.
template <class Real> std::array<Real, 2> position(const Flight<Real>& one, Real time) {
    const Real elapsed = time - one.time;
    return {one.x + one.vx * elapsed, one.y + one.vy * elapsed};
}

/// Into how many tiles a box is cut.
struct TileCounts {
    int columns = 1;
    int rows = 1;

    int all() const { return columns * rows; }
    bool operator==(const TileCounts&) const = default;
};

/// A square box cut into equal rectangular tiles, row by row. Tiles at the walls reach out to infinity.
template <class Real> class TileGrid {
  public:
    TileGrid(Real box_side, const TileCounts& counts)
        : counts_(counts), width_(box_side / static_cast<Real>(counts.columns)),
          height_(box_side / static_cast<Real>(counts.rows)) {}

    int count() const { return counts_.all(); }

    /// How far it is, at least, across a tile from one that is beside it to one that is not; infinity if all
    /// are beside each other.
    Real least_side() const {
        return std::min(counts_.columns > 1 ? width_ : Bounds<Real>::infinity,
                        counts_.rows > 1 ? height_ : Bounds<Real>::infinity);
    }

    /// The tile of a point; the nearest one for a point outside.
    int tile_at(const std::array<Real, 2>& point) const {
        return along(point[1], height_, counts_.rows) * counts_.columns +
               along(point[0], width_, counts_.columns);
    }

    Bounds<Real> bounds(int tile) const {
        const int row = tile / counts_.columns;
        const int column = tile % counts_.columns;
        return {edge(column, width_, counts_.columns), edge(row, height_, counts_.rows),
                edge(column + 1, width_, counts_.columns), edge(row + 1, height_, counts_.rows)};
    }

    /// A tile and `margin` around it, as far as that is in the box.
    Area<Real> area_around(int tile, Real margin) const {
        const auto [left, width] = around(tile % counts_.columns, counts_.columns, width_, margin);
        const auto [bottom, height] = around(tile / counts_.columns, counts_.rows, height_, margin);
        return {.left = left, .bottom = bottom, .width = width, .height = height};
    }

    /// `body(other)` for a tile and those around it.
    template <class Body> void for_each_near(int tile, const Body& body) const {
        const auto [columns, rows] = counts_;
        const int row = tile / columns;
        const int column = tile % columns;
        for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows - 1); ++r) {
            for (int c = std::max(column - 1, 0); c <= std::min(column + 1, columns - 1); ++c) {
                body(r * columns + c);
            }
        }
    }

  private:
    /// Where column or row k of `count` begins, and how wide it is, with a margin.
    static std::array<Real, 2> around(int k, int count, Real side, Real margin) {
        const Real begin = std::max(static_cast<Real>(k) * side - margin, Real(0));
        const Real end = std::min(static_cast<Real>(k + 1) * side + margin, static_cast<Real>(count) * side);
        return {begin, end - begin};
    }

    static int along(Real position, Real side, int count) {
        const Real scaled = position / side;
        return scaled > 0 ? static_cast<int>(std::min(scaled, static_cast<Real>(count - 1))) : 0;
    }

    static Real edge(int k, Real side, int count) {
        return k == 0       ? -Bounds<Real>::infinity
               : k == count ? Bounds<Real>::infinity
                            : static_cast<Real>(k) * side;
    }

    TileCounts counts_;
    Real width_; ///< of a tile
    Real height_;
};

} // namespace carom
