#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/collisions/path.hpp"
#include "harness/support/format.hpp"
#include "harness/verify/disc_states.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// A stretch of a disc's path in a window of time.
struct PathPiece {
    std::size_t disc;
    Path path; ///< whole, from the collision before
    double begin;
    double end;
};

/// Looks for two discs that come nearer to each other than 2r, all along their paths: those that are within
/// reach of each other in place and in time meet in a cell of a grid, slab by slab of the time.
///
/// Discs may be nearer than 2r where the later of their two paths begins, as some are at the start: then
/// they come no nearer than that. That is, they part, or collide at once.
///
/// The time that a search takes grows like the number of pieces and the cells that discs fly through.
class PathSearch {
  public:
    PathSearch(const Scene& scene, const PathRounding& rounding)
        : radius_(scene.radius), side_(scene.side), discs_(scene.discs.size()), rounding_(rounding) {
        const double count = static_cast<double>(std::max(scene.discs.size(), std::size_t{1}));
        const double cell = std::max(4 * scene.radius, scene.side / std::sqrt(count));
        per_side_ = static_cast<int>(std::clamp(std::floor(scene.side / cell), 1.0, 4096.0));
        cell_side_ = side_ / static_cast<double>(per_side_);
        cell_begin_.resize(static_cast<std::size_t>(per_side_) * static_cast<std::size_t>(per_side_) + 1);
    }

    /// The first two that come too near, as a search happens to find them, or nothing. `pieces` are those of
    /// all discs in the window from `begin` to `end`, in any order.
    std::optional<std::string> too_near(std::vector<PathPiece> pieces, double begin, double end) {
        const std::int64_t slabs = slabs_of(pieces);
        if (slabs > 1) {
            std::ranges::sort(pieces, {}, &PathPiece::begin);
        }
        std::vector<const PathPiece*> active;
        auto next = pieces.begin();
        for (std::int64_t slab = 0; slab < slabs; ++slab) {
            const auto edge = [&](std::int64_t number) {
                return number == slabs
                           ? end
                           : begin + (end - begin) * static_cast<double>(number) / static_cast<double>(slabs);
            };
            const double from = edge(slab);
            const double to = edge(slab + 1);
            for (; next != pieces.end() && next->begin <= to; ++next) {
                active.push_back(&*next);
            }
            segments_.clear();
            for (const PathPiece* piece : active) {
                cut(*piece, std::max(from, piece->begin), std::min(to, piece->end), 0);
            }
            sort_into_cells();
            if (auto violation = too_near_in_slab()) {
                return violation;
            }
            std::erase_if(active, [to](const PathPiece* piece) { return piece->end <= to; });
        }
        return std::nullopt;
    }

  private:
    /// A segment in more cells is halved, but no more often than this: what flies by at any speed is soon
    /// beyond the box, all of which is in the cells at its edge.
    static constexpr int few_cells = 16;
    static constexpr int most_halvings = 40;
    static constexpr double most_slabs = 1e6;

    struct CellRange {
        int first_row;
        int last_row;
        int first_column;
        int last_column;

        int cells() const { return (last_row - first_row + 1) * (last_column - first_column + 1); }
    };

    /// The box around a stretch of a disc's centre's path.
    struct Bounds {
        double low_x;
        double high_x;
        double low_y;
        double high_y;

        bool within(double reach, const Bounds& other) const {
            return low_x - other.high_x < reach && other.low_x - high_x < reach &&
                   low_y - other.high_y < reach && other.low_y - high_y < reach;
        }
    };

    /// So short a piece that it lies in few cells.
    struct Segment {
        const PathPiece* piece;
        double begin;
        double end;
        Bounds bounds;
        CellRange cells;
    };

    /// So many that a disc meets some others, and flies about one cell far, in each.
    std::int64_t slabs_of(const std::vector<PathPiece>& pieces) const {
        double cells = 0;
        for (const PathPiece& piece : pieces) {
            const double speed = std::abs(piece.path.start.vx) + std::abs(piece.path.start.vy);
            cells += std::min(speed * (piece.end - piece.begin), 2 * side_) / cell_side_;
        }
        const double discs = static_cast<double>(std::max(discs_, std::size_t{1}));
        const double per_disc = std::max(cells, static_cast<double>(pieces.size()) / 4) / discs;
        return static_cast<std::int64_t>(std::clamp(std::ceil(per_disc), 1.0, most_slabs));
    }

    void cut(const PathPiece& piece, double begin, double end, int halvings) {
        const Bounds bounds = bounds_of(piece, begin, end);
        const CellRange cells = cells_of(bounds);
        const double middle = begin + (end - begin) / 2;
        if (cells.cells() <= few_cells || halvings == most_halvings || !(begin < middle && middle < end)) {
            segments_.push_back({&piece, begin, end, bounds, cells});
            return;
        }
        cut(piece, begin, middle, halvings + 1);
        cut(piece, middle, end, halvings + 1);
    }

    static Bounds bounds_of(const PathPiece& piece, double begin, double end) {
        const Disc from = piece.path.at(begin);
        const Disc to = piece.path.at(end);
        return {std::min(from.x, to.x), std::max(from.x, to.x), std::min(from.y, to.y),
                std::max(from.y, to.y)};
    }

    CellRange cells_of(const Bounds& bounds) const {
        return {.first_row = along(bounds.low_y - radius_),
                .last_row = along(bounds.high_y + radius_),
                .first_column = along(bounds.low_x - radius_),
                .last_column = along(bounds.high_x + radius_)};
    }

    /// The row or column of a position along its axis. Those at the edges reach out to infinity.
    int along(double position) const {
        const double scaled = position / cell_side_;
        return scaled > 0 ? static_cast<int>(std::min(scaled, static_cast<double>(per_side_ - 1))) : 0;
    }

    void sort_into_cells() {
        const auto for_each_cell = [this](const CellRange& range, const auto& body) {
            for (int row = range.first_row; row <= range.last_row; ++row) {
                for (int column = range.first_column; column <= range.last_column; ++column) {
                    body(static_cast<std::size_t>(row * per_side_ + column));
                }
            }
        };
        std::ranges::fill(cell_begin_, 0);
        int entries = 0;
        for (const Segment& segment : segments_) {
            for_each_cell(segment.cells, [&](std::size_t cell) { ++cell_begin_[cell]; });
            entries += segment.cells.cells();
        }
        int end = 0;
        for (int& begin : cell_begin_) {
            end += begin;
            begin = end;
        }
        segment_order_.resize(static_cast<std::size_t>(entries));
        for (int k = static_cast<int>(segments_.size()) - 1; k >= 0; --k) {
            for_each_cell(segments_[static_cast<std::size_t>(k)].cells, [&](std::size_t cell) {
                segment_order_[static_cast<std::size_t>(--cell_begin_[cell])] = k;
            });
        }
    }

    std::optional<std::string> too_near_in_slab() const {
        for (int row = 0; row < per_side_; ++row) {
            for (int column = 0; column < per_side_; ++column) {
                if (auto violation = too_near_in_cell(row, column)) {
                    return violation;
                }
            }
        }
        return std::nullopt;
    }

    /// Two segments that share several cells are looked at in the first of these alone.
    std::optional<std::string> too_near_in_cell(int row, int column) const {
        const auto cell = static_cast<std::size_t>(row * per_side_ + column);
        const auto segment = [&](int entry) -> const Segment& {
            return segments_[static_cast<std::size_t>(segment_order_[static_cast<std::size_t>(entry)])];
        };
        for (int k = cell_begin_[cell]; k < cell_begin_[cell + 1]; ++k) {
            const Segment& one = segment(k);
            for (int m = cell_begin_[cell]; m < k; ++m) {
                const Segment& two = segment(m);
                if (one.bounds.within(2 * radius_, two.bounds) && one.piece->disc != two.piece->disc &&
                    one.begin <= two.end && two.begin <= one.end &&
                    std::max(one.cells.first_row, two.cells.first_row) == row &&
                    std::max(one.cells.first_column, two.cells.first_column) == column) {
                    if (auto violation = violation_of(one, two)) {
                        return violation;
                    }
                }
            }
        }
        return std::nullopt;
    }

    std::optional<std::string> violation_of(const Segment& one, const Segment& two) const {
        const Path& path = one.piece->path;
        const Path& other = two.piece->path;
        const double begin = std::max(one.begin, two.begin);
        const double duration = std::min(one.end, two.end) - begin;
        const Disc d = seen_from(path.at(begin), other.at(begin));
        const double approach = parting_of(d);
        const double speed_squared = d.vx * d.vx + d.vy * d.vy;
        const double nearest = approach < 0 ? std::min(-approach / speed_squared, duration) : 0.0;
        const double x = d.x + d.vx * nearest;
        const double y = d.y + d.vy * nearest;
        if (x * x + y * y >= 4 * radius_ * radius_) {
            return std::nullopt;
        }
        const double time = begin + nearest;
        const double first = std::max(path.time, other.time);
        const double first_distance = distance_of(seen_from(path.at(first), other.at(first)));
        const double depth = std::min(2 * radius_, first_distance) - std::hypot(x, y);
        const double allowed = rounding_.place(path, time) + rounding_.place(other, time) +
                               rounding_.gap(std::sqrt(speed_squared), time, first_distance);
        if (depth <= allowed) {
            return std::nullopt;
        }
        return format("discs %zu and %zu come %.3g too near each other, without a collision, at time %.17g",
                      std::min(one.piece->disc, two.piece->disc), std::max(one.piece->disc, two.piece->disc),
                      depth, time);
    }

    double radius_;
    double side_;
    std::size_t discs_;
    PathRounding rounding_;
    int per_side_;
    double cell_side_;
    std::vector<Segment> segments_;  ///< of one slab
    std::vector<int> cell_begin_;    ///< of each cell its first entry; at the end their number
    std::vector<int> segment_order_; ///< entries: segments, cell by cell
};

} // namespace carom
