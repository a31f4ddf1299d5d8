#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "kernels/exact/event_cells.hpp"
#include "kernels/exact/flight.hpp"

namespace carom {

/// A rectangle with sides along the axes; one of nothing until it is widened.
template <class Real> struct Bounds {
    static constexpr Real infinity = std::numeric_limits<Real>::infinity();

    Real left = infinity;
    Real bottom = infinity;
    Real right = -infinity;
    Real top = -infinity;

    void widen(const std::array<Real, 2>& point) {
        const auto [x, y] = point;
        left = std::min(left, x);
        bottom = std::min(bottom, y);
        right = std::max(right, x);
        top = std::max(top, y);
    }

    /// How far another one is along the axis along which it is farther; 0 or less if they meet.
    Real distance(const Bounds& other) const {
        return std::max({other.left - right, left - other.right, other.bottom - top, bottom - other.top});
    }
    Real distance(const std::array<Real, 2>& point) const {
        return distance({point[0], point[1], point[0], point[1]});
    }

    /// How far inside a point is; below 0 if it is outside.
    Real depth(const std::array<Real, 2>& point) const {
        return std::min({point[0] - left, right - point[0], point[1] - bottom, top - point[1]});
    }
};

/// Where a disc is at a time from its last collision on.
template <class Real> std::array<Real, 2> position(const Flight<Real>& one, Real time) {
    const Real elapsed = time - one.time;
    return {one.x + one.vx * elapsed, one.y + one.vy * elapsed};
}

/// A square box cut into equal square tiles, row by row. Tiles at the walls reach out to infinity.
template <class Real> class TileGrid {
  public:
    TileGrid(Real box_side, int per_side)
        : per_side_(per_side), side_(box_side / static_cast<Real>(per_side)) {}

    int count() const { return per_side_ * per_side_; }
    Real tile_side() const { return side_; }

    /// The tile of a point; the nearest one for a point outside.
    int tile_at(const std::array<Real, 2>& point) const {
        return along(point[1]) * per_side_ + along(point[0]);
    }

    Bounds<Real> bounds(int tile) const {
        const int row = tile / per_side_;
        const int column = tile % per_side_;
        return {edge(column), edge(row), edge(column + 1), edge(row + 1)};
    }

    /// A tile and `margin` around it.
    Square<Real> square_around(int tile, Real margin) const {
        return {.left = static_cast<Real>(tile % per_side_) * side_ - margin,
                .bottom = static_cast<Real>(tile / per_side_) * side_ - margin,
                .side = side_ + 2 * margin};
    }

    /// `body(other)` for a tile and those around it.
    template <class Body> void for_each_near(int tile, const Body& body) const {
        const int row = tile / per_side_;
        const int column = tile % per_side_;
        for (int r = std::max(row - 1, 0); r <= std::min(row + 1, per_side_ - 1); ++r) {
            for (int c = std::max(column - 1, 0); c <= std::min(column + 1, per_side_ - 1); ++c) {
                body(r * per_side_ + c);
            }
        }
    }

  private:
    int along(Real position) const {
        const Real scaled = position / side_;
        return scaled > 0 ? static_cast<int>(std::min(scaled, static_cast<Real>(per_side_ - 1))) : 0;
    }

    Real edge(int k) const {
        return k == 0           ? -Bounds<Real>::infinity
               : k == per_side_ ? Bounds<Real>::infinity
                                : static_cast<Real>(k) * side_;
    }

    int per_side_;
    Real side_;
};

} // namespace carom
