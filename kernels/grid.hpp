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

    int count() const { return last - first + 1; }
};

/// The geometry of a square of boxes laid over the scene. A centre outside the scene belongs to the nearest
/// box at the edge. Computed in double whatever the precision of the discs: an index must not depend on
/// rounding.
///
/// wide: w = 4r + 1, the published side, which gives the checkered and the row order their proof
/// (resolve.hpp): at least 4r. The index of a box is that of the published program, floor(position / w) as
/// rounded, and so is the half of its box in which a disc lies (but see `nearer_side`). Three departures,
/// none of which touches the published scenes: for huge radii the 1 drowns in rounding, so the side is at
/// least 4r (1 + 2^-20); there are at most 4096 boxes along a side, so that a huge empty scene costs memory
/// for its discs and not for its emptiness; and there is one box at least. snug: 2r (1 + 2^-20), the reach of
/// a disc, but no less than the mean distance between discs, sqrt(L^2 / N), so that there are about N boxes
/// at most. Scale-free. It leaves no rest to put into the last box.
class Grid {
  public:
    Grid(double side, double radius, int count = 1, BoxSide choice = BoxSide::wide,
         Rest rest = Rest::own_box) {
        constexpr double slack = 1 + 0x1p-20;
        const bool wide = choice == BoxSide::wide;
        const double least = wide ? std::max(4 * radius + 1, 4 * radius * slack)
                                  : std::max(2 * radius * slack, side / std::sqrt(std::max(count, 1)));
        const double most_per_side = wide ? 4096 : 32768;
        const double fitting = rest == Rest::own_box ? std::ceil(side / least) : std::floor(side / least);
        boxes_per_side_ = static_cast<int>(std::clamp(fitting, 1.0, most_per_side));
        box_side_ = fitting > most_per_side ? side / most_per_side : least;
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
        const double scaled = position / box_side_;
        if (!(scaled > 0)) {
            return 0;
        }
        return scaled < boxes_per_side_ ? static_cast<int>(scaled) : boxes_per_side_ - 1;
    }

    /// The neighbour, along one axis, that a disc at `position` of a wide grid can reach into: -1 from its
    /// box's lower half, +1 from its upper half. A disc reaches 2r and half a wide box is more than 2r. (A
    /// wider last box has several halves, of which only the first is within reach of another box.)
    ///
    /// The published program asks whether fmod(position, w) >= w / 2, which is the same but for a position so
    /// little below an edge that position / w is rounded up to a whole number: it is then put into the next
    /// box and looks away from the edge, so that the pair stands in the other disc's list alone.
    int nearer_side(double position) const {
        const double offset = position - std::trunc(position / box_side_) * box_side_;
        return offset >= box_side_ / 2 ? 1 : -1;
    }

    /// Can a disc of this box touch a wall? The low walls are within r of box 0 alone, since a box is wider
    /// than r.
    bool at_wall(int row, int column) const {
        return row == 0 || column == 0 || row >= first_high_ || column >= first_high_;
    }

  private:
    int boxes_per_side_ = 1;
    double box_side_ = 1;
    int first_high_ = 0; ///< no box below this row or column can touch the high wall
};

} // namespace carom
