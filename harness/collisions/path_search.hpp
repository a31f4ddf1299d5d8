#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/collisions/path.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// A stretch of a disc's path in a window of time.
template <class Real> struct Piece {
    std::size_t disc;
    Path<Real> path; ///< whole, from the collision before
    Real begin;
    Real end;
};

/// Looks for two discs that come nearer to each other than 2r, all along their paths: those that are within
/// reach of each other in place and in time meet in a cell of a grid, slab by slab of the time.
///
/// Discs may be nearer than 2r where the later of their two paths begins, as some are at the start: then
/// they come no nearer than that. That is, they part, or collide at once.
///
/// The time that a search takes grows like the number of pieces and the cells that discs fly through.
template <class Real> class PathSearch {
  public:
    PathSearch(const Scene& scene, const PathRounding<Real>& rounding);

    /// The first two that come too near, as a search happens to find them, or nothing. `pieces` are those of
    /// all discs in the window from `begin` to `end`, in any order.
    std::optional<std::string> too_near(std::vector<Piece<Real>> pieces, Real begin, Real end);

  private:
    struct CellRange {
        int first_row;
        int last_row;
        int first_column;
        int last_column;

        int cells() const { return (last_row - first_row + 1) * (last_column - first_column + 1); }
    };

    /// The box around a stretch of a disc's centre's path.
    struct Bounds {
        Real low_x;
        Real high_x;
        Real low_y;
        Real high_y;

        bool within(Real reach, const Bounds& other) const {
            return low_x - other.high_x < reach && other.low_x - high_x < reach &&
                   low_y - other.high_y < reach && other.low_y - high_y < reach;
        }
    };

    /// So short a piece that it lies in few cells.
    struct Segment {
        const Piece<Real>* piece;
        Real begin;
        Real end;
        Bounds bounds;
        CellRange cells;
    };

    std::int64_t slabs_of(const std::vector<Piece<Real>>& pieces) const;
    void cut(const Piece<Real>& piece, Real begin, Real end, int halvings);
    static Bounds bounds_of(const Piece<Real>& piece, Real begin, Real end);
    CellRange cells_of(const Bounds& bounds) const;
    int along(Real position) const;
    void sort_into_cells();
    std::optional<std::string> too_near_in_slab() const;
    std::optional<std::string> too_near_in_cell(int row, int column) const;
    std::optional<std::string> violation_of(const Segment& one, const Segment& two) const;

    Real radius_;
    Real side_;
    std::size_t discs_;
    PathRounding<Real> rounding_;
    int per_side_;
    Real cell_side_;
    std::vector<Segment> segments_;  ///< of one slab
    std::vector<int> cell_begin_;    ///< of each cell its first entry; at the end their number
    std::vector<int> segment_order_; ///< entries: segments, cell by cell
};

} // namespace carom
