#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "kernels/scene.hpp"

namespace carom {

/// The cells of the exact reference, at least 2r wide, and which discs are in each. The cells at the edges
/// reach out to infinity, so that every disc is in one. Around them lies a border of cells that stay empty,
/// so that every cell has eight neighbours.
template <class Real> class EventCells {
  public:
    static constexpr int at_hand = 3;

    /// The discs of a cell, the latest first: three at hand, which is nearly always all of them, and those
    /// before them by `before`. What stands behind the last disc at hand is the number of some disc.
    struct Cell {
        int count = 0;
        std::array<int, at_hand> discs{};
    };

    explicit EventCells(const Scene& scene) : before_(scene.discs.size()) {
        const auto count = static_cast<double>(scene.discs.size());
        const double spacing = std::max(2.0 * scene.radius * (1 + 1e-9), scene.side / std::sqrt(count + 1));
        const double per_side = std::clamp(std::floor(scene.side / spacing), 1.0, 10'000.0);
        cell_side_ = static_cast<Real>(scene.side) / static_cast<Real>(per_side);
        for (int edge = 0; edge <= static_cast<int>(per_side); ++edge) {
            edges_.push_back(static_cast<Real>(edge) * cell_side_);
        }
        edges_.front() = -std::numeric_limits<Real>::infinity();
        edges_.back() = std::numeric_limits<Real>::infinity();
        stride_ = static_cast<int>(per_side) + 2;
        cells_.resize(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(stride_));
    }

    /// Takes all discs out.
    void clear() { std::ranges::fill(cells_, Cell{}); }

    /// What to add to the number of a cell for the cell in the next row; for the next column it is 1.
    int stride() const { return stride_; }

    /// A cell and its eight neighbours: what to add to its number.
    std::array<int, 9> nine() const {
        return {-stride_ - 1, -stride_, -stride_ + 1, -1, 0, 1, stride_ - 1, stride_, stride_ + 1};
    }

    int cell_at(Real x, Real y) const { return (along(y) + 1) * stride_ + along(x) + 1; }

    /// Where a disc that flies up or down along an axis leaves the cell; infinity at the edge of the box.
    Real edge_x(int cell, bool up) const { return edge(cell % stride_ - 1, up); }
    Real edge_y(int cell, bool up) const { return edge(cell / stride_ - 1, up); }

    const Cell& operator[](int cell) const { return cells_[static_cast<std::size_t>(cell)]; }

    /// The disc that came into the same cell before disc i, unless disc i is at hand and not the last there.
    int before(int i) const { return before_[static_cast<std::size_t>(i)]; }

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
    /// The row or column of a position along its axis.
    int along(Real position) const {
        const Real scaled = position / cell_side_;
        return scaled > 0 ? static_cast<int>(std::min(scaled, static_cast<Real>(stride_ - 3))) : 0;
    }

    Real edge(int index, bool up) const { return edges_[static_cast<std::size_t>(index + (up ? 1 : 0))]; }

    Real cell_side_;
    int stride_;
    std::vector<Real> edges_; ///< between rows, and between columns
    std::vector<Cell> cells_;
    std::vector<int> before_;
};

} // namespace carom
