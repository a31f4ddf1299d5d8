#pragma once

#include <algorithm>
#include <array>
#include <limits>

namespace carom {

/// A rectangle of the plane, from its lower left corner.
template <class Real> struct Area {
    Real left = 0;
    Real bottom = 0;
    Real width = 0;
    Real height = 0;

    Real size() const { return width * height; }
};

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

    /// The same, so much narrower on each side.
    Bounds shrunk(Real margin) const {
        return {left + margin, bottom + margin, right - margin, top - margin};
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
    /// The same of all of another one.
    Real depth(const Bounds& other) const {
        return std::min({other.left - left, right - other.right, other.bottom - bottom, top - other.top});
    }
};

} // namespace carom
