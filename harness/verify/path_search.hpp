#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/support/format.hpp"
#include "harness/verify/disc_states.hpp"
#include "harness/verify/path.hpp"
#include "harness/verify/sort_and_sweep.hpp"

namespace carom {

/// A stretch of a disc's path in a window of time.
struct PathPiece {
    std::size_t disc;
    Path path; ///< whole, from the collision before
    double begin;
    double end;
};

/// Looks for two discs that come nearer to each other than 2r, all along their paths. Time is cut into slabs;
/// in a slab the rectangles around discs on their way are sorted and swept.
///
/// Discs may be nearer than 2r where the later of their two paths begins, as some are at the start: then
/// they come no nearer than that. That is, they part, or collide at once.
class PathSearch {
  public:
    PathSearch(double side, double radius, std::size_t discs)
        : side_(side), radius_(radius), discs_(static_cast<double>(std::max(discs, std::size_t{1}))),
          rounding_(side, radius, discs_) {}

    /// The first two that come too near, as a search happens to find them, or nothing. `pieces` are those of
    /// all discs in the window from `begin` to `end`, in any order.
    std::optional<std::string> too_near(std::vector<PathPiece> pieces, double begin, double end) const {
        const double slabs = slabs_of(pieces);
        std::ranges::sort(pieces, {}, &PathPiece::begin);
        std::optional<std::string> violation;
        std::vector<PathPiece> active;
        auto next = pieces.begin();
        double from = begin;
        for (double slab = 1; slab <= slabs && !violation; ++slab) {
            const double to = slab == slabs ? end : begin + (end - begin) * (slab / slabs);
            for (; next != pieces.end() && next->begin <= to; ++next) {
                active.push_back(*next);
            }
            for_each_meeting(extents(active, from, to), [&](std::size_t one, std::size_t two) {
                if (!violation && active[one].disc != active[two].disc) {
                    violation = violation_of(active[one], active[two], from, to);
                }
            });
            std::erase_if(active, [to](const PathPiece& piece) { return piece.end <= to; });
            from = to;
        }
        return violation;
    }

    const PathRounding& rounding() const { return rounding_; }

  private:
    /// So many that a disc meets some others, and flies about as far as others are, in each.
    double slabs_of(const std::vector<PathPiece>& pieces) const {
        constexpr double most = 1e6;
        const double apart = std::max(4 * radius_, side_ / std::sqrt(discs_));
        double flown = 0;
        for (const PathPiece& piece : pieces) {
            flown += std::min(piece.path.length(piece.end) - piece.path.length(piece.begin), 2 * side_);
        }
        const double per_disc = std::max(flown / apart, static_cast<double>(pieces.size()) / 4) / discs_;
        return std::clamp(std::ceil(per_disc), 1.0, most);
    }

    /// Around all of each disc on its way.
    std::vector<Extent> extents(const std::vector<PathPiece>& pieces, double from, double to) const {
        std::vector<Extent> result;
        for (const PathPiece& piece : pieces) {
            const Disc first = piece.path.at(std::max(from, piece.begin));
            const Disc last = piece.path.at(std::min(to, piece.end));
            const auto [low_x, high_x] = std::minmax(first.x, last.x);
            const auto [low_y, high_y] = std::minmax(first.y, last.y);
            result.push_back({low_x - radius_, high_x + radius_, low_y - radius_, high_y + radius_});
        }
        return result;
    }

    std::optional<std::string> violation_of(const PathPiece& one, const PathPiece& two, double from,
                                            double to) const {
        const double begin = std::max({from, one.begin, two.begin});
        const double duration = std::min({to, one.end, two.end}) - begin;
        if (duration < 0) {
            return std::nullopt;
        }
        const Disc d = seen_from(one.path.at(begin), two.path.at(begin));
        const double approach = parting_of(d);
        const double speed_squared = d.vx * d.vx + d.vy * d.vy;
        const double nearest = approach < 0 ? std::min(-approach / speed_squared, duration) : 0.0;
        const double x = d.x + d.vx * nearest;
        const double y = d.y + d.vy * nearest;
        if (x * x + y * y >= 4 * radius_ * radius_) {
            return std::nullopt;
        }
        const double time = begin + nearest;
        const double first = std::max(one.path.time, two.path.time);
        const double first_distance = distance_of(seen_from(one.path.at(first), two.path.at(first)));
        const double depth = std::min(2 * radius_, first_distance) - std::hypot(x, y);
        const double allowed = rounding_.place(one.path, time) + rounding_.place(two.path, time) +
                               rounding_.gap(std::sqrt(speed_squared), time, first_distance);
        if (depth <= allowed) {
            return std::nullopt;
        }
        return format("discs %zu and %zu come %.3g too near each other, without a collision, at time %.17g",
                      std::min(one.disc, two.disc), std::max(one.disc, two.disc), depth, time);
    }

    double side_;
    double radius_;
    double discs_;
    PathRounding rounding_;
};

} // namespace carom
