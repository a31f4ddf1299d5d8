#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
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

/// Looks for two discs that come nearer to each other than 2r, all along their paths. Time is cut into slabs;
/// in a slab those of one row of the box are sorted by where they begin along x and swept.
///
/// Discs may be nearer than 2r where the later of their two paths begins, as some are at the start: then
/// they come no nearer than that. That is, they part, or collide at once.
class PathSearch {
  public:
    PathSearch(const Scene& scene, const PathRounding& rounding)
        : radius_(scene.radius), side_(scene.side),
          discs_(static_cast<double>(std::max(scene.discs.size(), std::size_t{1}))), rounding_(rounding),
          rows_(std::clamp(std::floor(side_ / std::max(4 * radius_, side_ / std::sqrt(discs_))), 1.0,
                           4096.0)) {}

    /// The first two that come too near, as a search happens to find them, or nothing. `pieces` are those of
    /// all discs in the window from `begin` to `end`, in any order.
    std::optional<std::string> too_near(std::vector<PathPiece> pieces, double begin, double end) const {
        const double slabs = slabs_of(pieces);
        std::ranges::sort(pieces, {}, &PathPiece::begin);
        std::vector<PathPiece> active;
        auto next = pieces.begin();
        double from = begin;
        for (double slab = 1; slab <= slabs; ++slab) {
            const double to = slab == slabs ? end : begin + (end - begin) * (slab / slabs);
            for (; next != pieces.end() && next->begin <= to; ++next) {
                active.push_back(*next);
            }
            if (auto violation = too_near_in_slab(active, from, to)) {
                return violation;
            }
            std::erase_if(active, [to](const PathPiece& piece) { return piece.end <= to; });
            from = to;
        }
        return std::nullopt;
    }

  private:
    /// A piece in a slab, in one of the rows that it lies in, with the box around all of the disc on its way.
    struct Way {
        const PathPiece* piece;
        double begin;
        double end;
        double low_x = 0;
        double high_x = 0;
        double low_y = 0;
        double high_y = 0;
        double first_row = 0;
        double row = 0;
    };

    /// So many that a disc meets some others, and flies about one row far, in each.
    double slabs_of(const std::vector<PathPiece>& pieces) const {
        constexpr double most = 1e6;
        double rows = 0;
        for (const PathPiece& piece : pieces) {
            const double flown = piece.path.length(piece.end) - piece.path.length(piece.begin);
            rows += std::min(flown, 2 * side_) / side_ * rows_;
        }
        const double per_disc = std::max(rows, static_cast<double>(pieces.size()) / 4) / discs_;
        return std::clamp(std::ceil(per_disc), 1.0, most);
    }

    /// The rows at the edges reach out to infinity.
    double row_of(double y) const { return y > 0 ? std::min(std::floor(y / side_ * rows_), rows_ - 1) : 0; }

    std::vector<Way> sorted_ways(const std::vector<PathPiece>& pieces, double from, double to) const {
        std::vector<Way> ways;
        for (const PathPiece& piece : pieces) {
            Way way{.piece = &piece, .begin = std::max(from, piece.begin), .end = std::min(to, piece.end)};
            const Disc first = piece.path.at(way.begin);
            const Disc last = piece.path.at(way.end);
            std::tie(way.low_x, way.high_x) = std::minmax(first.x, last.x);
            std::tie(way.low_y, way.high_y) = std::minmax(first.y, last.y);
            way.low_x -= radius_;
            way.high_x += radius_;
            way.low_y -= radius_;
            way.high_y += radius_;
            way.first_row = row_of(way.low_y);
            for (way.row = way.first_row; way.row <= row_of(way.high_y); ++way.row) {
                ways.push_back(way);
            }
        }
        std::ranges::sort(ways, {}, [](const Way& way) { return std::pair(way.row, way.low_x); });
        return ways;
    }

    /// Two that share several rows are looked at in the first of these alone.
    std::optional<std::string> too_near_in_slab(const std::vector<PathPiece>& pieces, double from,
                                                double to) const {
        const std::vector<Way> ways = sorted_ways(pieces, from, to);
        for (auto one = ways.begin(); one != ways.end(); ++one) {
            for (auto two = one + 1; two != ways.end() && two->row == one->row && two->low_x <= one->high_x;
                 ++two) {
                if (one->low_y <= two->high_y && two->low_y <= one->high_y && one->begin <= two->end &&
                    two->begin <= one->end && std::max(one->first_row, two->first_row) == one->row &&
                    one->piece->disc != two->piece->disc) {
                    if (auto violation = violation_of(*one, *two)) {
                        return violation;
                    }
                }
            }
        }
        return std::nullopt;
    }

    std::optional<std::string> violation_of(const Way& one, const Way& two) const {
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
    double discs_;
    PathRounding rounding_;
    double rows_;
};

} // namespace carom
