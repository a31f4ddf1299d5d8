#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "kernels/exact/rectangle.hpp"

namespace carom {

/// The cells of the exact reference in an area, at least 2r wide and high, and which discs are in each. The
/// cells at the edges reach out to infinity, so that every disc is in one. Around them lies a border of cells
/// that stay empty, so that every cell has eight neighbours.
template <class Real> class EventCells {
  public:
    static constexpr int at_hand = 3;
    static constexpr int most_per_side = 10'000;

    /// The discs of a cell, the latest first: three at hand, which is nearly always all of them, and those
    /// before them by `before`. What stands behind the last disc at hand is the number of some disc.
    struct Cell {
        int count = 0;
        std::array<int, at_hand> discs{};
    };

    EventCells() = default;
    EventCells(const Area<Real>& area, std::size_t count, Real radius) { arrange(area, count, radius); }

    /// Empty cells for so many discs of that radius, so many a side at most. Keeps the memory it has.
    void arrange(const Area<Real>& area, std::size_t count, Real radius, int most = most_per_side) {
        const auto width = static_cast<double>(area.width);
        const auto height = static_cast<double>(area.height);
        const double spacing = std::max(2.0 * static_cast<double>(radius) * (1 + 1e-9),
                                        std::sqrt(width * height / (static_cast<double>(count) + 1)));
        const auto per_side = [&](double side) {
            return std::clamp(std::floor(side / spacing), 1.0, static_cast<double>(most));
        };
        stride_ = static_cast<int>(per_side(width)) + 2;
        rows_ = static_cast<int>(per_side(height));
        cell_width_ = area.width / static_cast<Real>(stride_ - 2);
        cell_height_ = area.height / static_cast<Real>(rows_);
        left_ = area.left;
        bottom_ = area.bottom;
        place_edges(edges_x_, left_, cell_width_, stride_ - 2);
        place_edges(edges_y_, bottom_, cell_height_, rows_);
        cells_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_ + 2), Cell{});
        before_.resize(count);
    }

    /// Makes room for as many discs.
    void hold(std::size_t count) { before_.resize(std::max(before_.size(), count)); }

    /// What to add to the number of a cell for the cell in the next row; for the next column it is 1.
    int stride() const { return stride_; }

    /// A cell and its eight neighbours: what to add to its number.
    std::array<int, 9> nine() const {
        return {-stride_ - 1, -stride_, -stride_ + 1, -1, 0, 1, stride_ - 1, stride_, stride_ + 1};
    }

    int cell_at(Real x, Real y) const {
        const int row = along(y - bottom_, cell_height_, rows_);
        return (row + 1) * stride_ + along(x - left_, cell_width_, stride_ - 2) + 1;
    }

    /// Where a disc that flies up or down along an axis leaves the cell; infinity at the edge of the box.
    Real edge_x(int cell, bool up) const { return edge(edges_x_, cell % stride_ - 1, up); }
    Real edge_y(int cell, bool up) const { return edge(edges_y_, cell / stride_ - 1, up); }

    const Cell& operator[](int cell) const { return cells_[static_cast<std::size_t>(cell)]; }

    /// The disc that came into the same cell before disc i, unless disc i is at hand and not the last there.
    int before(int i) const { return before_[static_cast<std::size_t>(i)]; }

    /// `body(disc)` for each disc in a cell that is not wholly inside a rectangle.
    template <class Body> void for_each_disc_outside(const Bounds<Real>& inside, const Body& body) const {
        const int columns_in_all = stride_ - 2;
        const auto [first_column, end_column] = within(edges_x_, inside.left, inside.right);
        const auto [first_row, end_row] = within(edges_y_, inside.bottom, inside.top);
        for (int row = 0; row < rows_; ++row) {
            const bool goes_through = first_row <= row && row < end_row;
            const int first = (row + 1) * stride_ + 1;
            for_each_disc_in(first, first + (goes_through ? first_column : columns_in_all), body);
            for_each_disc_in(first + (goes_through ? end_column : columns_in_all), first + columns_in_all,
                             body);
        }
    }

    void insert(int i, int cell) {
        Cell& one = cells_[static_cast<std::size_t>(cell)];
        const auto [first, second, third] = one.discs;
        if (one.count >= at_hand) {
            before_[static_cast<std::size_t>(second)] = third;
        }
        one.discs = {i, first, second};
        ++one.count;
    }

    void remove(int i, int cell) {
        Cell& one = cells_[static_cast<std::size_t>(cell)];
        const auto [first, second, third] = one.discs;
        if (i == first || i == second || i == third) {
            const int fourth = one.count > at_hand ? before(third) : 0;
            one.discs = {i == first ? second : first, i == third ? second : third, fourth};
        } else {
            int after = third;
            while (before(after) != i) {
                after = before(after);
            }
            before_[static_cast<std::size_t>(after)] = before(i);
        }
        --one.count;
    }

  private:
    /// The row or column, of so many, of a position along its axis.
    static int along(Real position, Real cell_side, int count) {
        const Real scaled = position / cell_side;
        return scaled > 0 ? static_cast<int>(std::min(scaled, static_cast<Real>(count - 1))) : 0;
    }

    /// Of the rows or columns between edges, the first and the one after the last wholly between two places.
    static std::array<int, 2> within(const std::vector<Real>& edges, Real begin, Real end) {
        const auto first = std::ranges::lower_bound(edges, begin) - edges.begin();
        const auto last = std::ranges::upper_bound(edges, end) - edges.begin() - 1;
        return {static_cast<int>(first), static_cast<int>(std::max(first, last))};
    }

    /// The same for each disc in cells from the first one until before the last one.
    template <class Body> void for_each_disc_in(int first, int last, const Body& body) const {
        for (int cell = first; cell < last; ++cell) {
            const Cell& one = (*this)[cell];
            for (int k = 0, disc = 0; k < one.count; ++k) {
                disc = k < at_hand ? one.discs[static_cast<std::size_t>(k)] : before(disc);
                body(disc);
            }
        }
    }

    static void place_edges(std::vector<Real>& edges, Real begin, Real cell_side, int count) {
        edges.clear();
        for (int edge = 0; edge <= count; ++edge) {
            edges.push_back(begin + static_cast<Real>(edge) * cell_side);
        }
        edges.front() = -std::numeric_limits<Real>::infinity();
        edges.back() = std::numeric_limits<Real>::infinity();
    }

    static Real edge(const std::vector<Real>& edges, int index, bool up) {
        return edges[static_cast<std::size_t>(index + (up ? 1 : 0))];
    }

    Real cell_width_ = 0;
    Real cell_height_ = 0;
    Real left_ = 0;
    Real bottom_ = 0;
    int stride_ = 0;            ///< columns and both borders
    int rows_ = 0;              ///< without the borders
    std::vector<Real> edges_x_; ///< between columns
    std::vector<Real> edges_y_; ///< between rows
    std::vector<Cell> cells_;
    std::vector<int> before_;
};

} // namespace carom
