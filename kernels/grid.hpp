#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "policies.hpp"

namespace carom {

/// An inclusive range of boxes along one axis, or of rows.
struct BoxRange {
    int first;
    int last;
};

/// The geometry of a square of boxes laid over the scene. A centre outside the scene belongs to the nearest
/// box at the edge. Computed in double whatever the precision of the discs: an index must not depend on
/// rounding.
///
/// wide: 4r + 1, the published side, which gives the checkered and the row order their proof (resolve.hpp):
/// at least 4r. Two departures, neither of which touches the published scenes: for huge radii the 1 drowns in
/// rounding, so the side is at least 4r (1 + 2^-20); and there are at most 4096 boxes along a side, so that a
/// huge empty scene costs memory for its discs and not for its emptiness.
/// snug: 2r (1 + 2^-20), the reach of a disc, but no less than the mean distance between discs, sqrt(L^2 /
/// N), so that there are about N boxes at most. Scale-free.
class Grid {
  public:
    Grid(double side, double radius, int count = 1, BoxSide choice = BoxSide::wide) {
        constexpr double slack = 1 + 0x1p-20;
        const bool wide = choice == BoxSide::wide;
        const double least = wide ? std::max(4 * radius + 1, 4 * radius * slack)
                                  : std::max(2 * radius * slack, side / std::sqrt(std::max(count, 1)));
        const double most_per_side = wide ? 4096 : 32768;
        boxes_per_side_ = static_cast<int>(std::clamp(std::ceil(side / least), 1.0, most_per_side));
        box_side_ = std::max(least, side / boxes_per_side_);
        per_length_ = 1 / box_side_;
        first_high_ = coordinate(side - radius - side * std::numeric_limits<double>::epsilon());
    }

    int boxes_per_side() const { return boxes_per_side_; }
    double box_side() const { return box_side_; }
    int box_count() const { return boxes_per_side_ * boxes_per_side_; }
    int box_of(int row, int column) const { return row * boxes_per_side_ + column; }

    /// The strips of `height` rows of boxes each (the last may have fewer) and the rows of one of them.
    int strip_count(int height) const { return (boxes_per_side_ + height - 1) / height; }
    BoxRange rows_of_strip(int strip, int height) const {
        return {strip * height, std::min((strip + 1) * height, boxes_per_side_) - 1};
    }

    /// Index of the box, along one axis, that holds `position`; the nearest one for a position outside.
    int coordinate(double position) const {
        const double scaled = position * per_length_;
        if (!(scaled > 0)) {
            return 0;
        }
        return scaled < boxes_per_side_ ? static_cast<int>(scaled) : boxes_per_side_ - 1;
    }

    /// The neighbour, along one axis, that a disc at `position` in box `index` of a wide grid can reach into:
    /// -1 from the box's lower half, +1 from its upper half. A disc reaches 2r and half a wide box is more
    /// than 2r.
    int reach(double position, int index) const { return position * per_length_ - index < 0.5 ? -1 : 1; }

    /// Can a disc of this box touch a wall? The low walls are within r of box 0 alone, since a box is wider
    /// than r.
    bool at_wall(int row, int column) const {
        return row == 0 || column == 0 || row >= first_high_ || column >= first_high_;
    }

  private:
    int boxes_per_side_ = 1;
    double box_side_ = 1;
    double per_length_ = 1;
    int first_high_ = 0; ///< no box below this row or column can touch the high wall
};

} // namespace carom
