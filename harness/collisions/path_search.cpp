#include "harness/collisions/path_search.hpp"

#include <algorithm>
#include <cmath>

#include "harness/support/format.hpp"
#include "harness/verify/disc_states.hpp"

namespace carom {
namespace {

/// A segment in more cells is halved, but no more often than this: what flies by at any speed is soon beyond
/// the box, all of which is in the cells at its edge.
constexpr int few_cells = 16;
constexpr int most_halvings = 40;

constexpr double most_slabs = 1e6;

} // namespace

template <class Real>
PathSearch<Real>::PathSearch(const Scene& scene, const PathRounding<Real>& rounding)
    : radius_(static_cast<Real>(scene.radius)), side_(static_cast<Real>(scene.side)),
      discs_(scene.discs.size()), rounding_(rounding) {
    const double count = static_cast<double>(std::max(scene.discs.size(), std::size_t{1}));
    const double cell = std::max(4 * scene.radius, scene.side / std::sqrt(count));
    per_side_ = static_cast<int>(std::clamp(std::floor(scene.side / cell), 1.0, 4096.0));
    cell_side_ = side_ / static_cast<Real>(per_side_);
    cell_begin_.resize(static_cast<std::size_t>(per_side_) * static_cast<std::size_t>(per_side_) + 1);
}

template <class Real>
std::optional<std::string> PathSearch<Real>::too_near(std::vector<Piece<Real>> pieces, Real begin, Real end) {
    const std::int64_t slabs = slabs_of(pieces);
    if (slabs > 1) {
        std::ranges::sort(pieces, {}, &Piece<Real>::begin);
    }
    std::vector<const Piece<Real>*> active;
    auto next = pieces.begin();
    for (std::int64_t slab = 0; slab < slabs; ++slab) {
        const auto edge = [&](std::int64_t number) {
            return number == slabs
                       ? end
                       : begin + (end - begin) * static_cast<Real>(number) / static_cast<Real>(slabs);
        };
        const Real from = edge(slab);
        const Real to = edge(slab + 1);
        for (; next != pieces.end() && next->begin <= to; ++next) {
            active.push_back(&*next);
        }
        segments_.clear();
        for (const Piece<Real>* piece : active) {
            cut(*piece, std::max(from, piece->begin), std::min(to, piece->end), 0);
        }
        sort_into_cells();
        if (auto violation = too_near_in_slab()) {
            return violation;
        }
        std::erase_if(active, [to](const Piece<Real>* piece) { return piece->end <= to; });
    }
    return std::nullopt;
}

/// So many that a disc meets some others, and flies about one cell far, in each.
template <class Real> std::int64_t PathSearch<Real>::slabs_of(const std::vector<Piece<Real>>& pieces) const {
    double cells = 0;
    for (const Piece<Real>& piece : pieces) {
        const Real speed = std::abs(piece.path.start.vx) + std::abs(piece.path.start.vy);
        cells += static_cast<double>(std::min(speed * (piece.end - piece.begin), 2 * side_) / cell_side_);
    }
    const double discs = static_cast<double>(std::max(discs_, std::size_t{1}));
    const double per_disc = std::max(cells, static_cast<double>(pieces.size()) / 4) / discs;
    return static_cast<std::int64_t>(std::clamp(std::ceil(per_disc), 1.0, most_slabs));
}

template <class Real>
void PathSearch<Real>::cut(const Piece<Real>& piece, Real begin, Real end, int halvings) {
    const Bounds bounds = bounds_of(piece, begin, end);
    const CellRange cells = cells_of(bounds);
    const Real middle = begin + (end - begin) / 2;
    if (cells.cells() <= few_cells || halvings == most_halvings || !(begin < middle && middle < end)) {
        segments_.push_back({&piece, begin, end, bounds, cells});
        return;
    }
    cut(piece, begin, middle, halvings + 1);
    cut(piece, middle, end, halvings + 1);
}

template <class Real>
typename PathSearch<Real>::Bounds PathSearch<Real>::bounds_of(const Piece<Real>& piece, Real begin,
                                                              Real end) {
    const BasicDisc<Real> from = piece.path.at(begin);
    const BasicDisc<Real> to = piece.path.at(end);
    return {std::min(from.x, to.x), std::max(from.x, to.x), std::min(from.y, to.y), std::max(from.y, to.y)};
}

template <class Real>
typename PathSearch<Real>::CellRange PathSearch<Real>::cells_of(const Bounds& bounds) const {
    return {.first_row = along(bounds.low_y - radius_),
            .last_row = along(bounds.high_y + radius_),
            .first_column = along(bounds.low_x - radius_),
            .last_column = along(bounds.high_x + radius_)};
}

/// The row or column of a position along its axis. Those at the edges reach out to infinity.
template <class Real> int PathSearch<Real>::along(Real position) const {
    const Real scaled = position / cell_side_;
    return scaled > 0 ? static_cast<int>(std::min(scaled, static_cast<Real>(per_side_ - 1))) : 0;
}

template <class Real> void PathSearch<Real>::sort_into_cells() {
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

template <class Real> std::optional<std::string> PathSearch<Real>::too_near_in_slab() const {
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
template <class Real>
std::optional<std::string> PathSearch<Real>::too_near_in_cell(int row, int column) const {
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

template <class Real>
std::optional<std::string> PathSearch<Real>::violation_of(const Segment& one, const Segment& two) const {
    const Path<Real>& path = one.piece->path;
    const Path<Real>& other = two.piece->path;
    const Real begin = std::max(one.begin, two.begin);
    const Real duration = std::min(one.end, two.end) - begin;
    const BasicDisc<Real> d = seen_from(path.at(begin), other.at(begin));
    const Real approach = parting_of(d);
    const Real speed_squared = d.vx * d.vx + d.vy * d.vy;
    const Real nearest = approach < 0 ? std::min(-approach / speed_squared, duration) : Real{0};
    const Real x = d.x + d.vx * nearest;
    const Real y = d.y + d.vy * nearest;
    if (x * x + y * y >= 4 * radius_ * radius_) {
        return std::nullopt;
    }
    const Real time = begin + nearest;
    const Real first = std::max(path.time, other.time);
    const Real first_distance = distance_of(seen_from(path.at(first), other.at(first)));
    const Real depth = std::min(2 * radius_, first_distance) - std::hypot(x, y);
    const Real allowed = rounding_.place(path, time) + rounding_.place(other, time) +
                         rounding_.gap(std::sqrt(speed_squared), time, first_distance);
    if (depth <= allowed) {
        return std::nullopt;
    }
    return format("discs %zu and %zu come %.3g too near each other, without a collision, at time %.17g",
                  std::min(one.piece->disc, two.piece->disc), std::max(one.piece->disc, two.piece->disc),
                  static_cast<double>(depth), static_cast<double>(time));
}

template class PathSearch<double>;

} // namespace carom
