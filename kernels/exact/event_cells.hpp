#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "kernels/scene.hpp"

namespace carom {

/// The cells of the exact reference, at least 2r wide, and which discs are in each: a linked list a cell. The
/// cells at the edges reach out to infinity, so that every disc is in one.
template <class Real> class EventCells {
  public:
    static constexpr int none = -1;

    struct Place {
        int row = 0;
        int column = 0;
        int next = none; ///< in the same cell
        int previous = none;
    };

    explicit EventCells(const Scene& scene) : places_(scene.discs.size()) {
        const auto count = static_cast<double>(scene.discs.size());
        const double spacing = std::max(2.0 * scene.radius * (1 + 1e-9), scene.side / std::sqrt(count + 1));
        per_side_ = static_cast<int>(std::clamp(std::floor(scene.side / spacing), 1.0, 10'000.0));
        cell_side_ = static_cast<Real>(scene.side) / static_cast<Real>(per_side_);
        first_.assign(cell(per_side_, 0), none);
    }

    int per_side() const { return per_side_; }
    const Place& place(int i) const { return places_[static_cast<std::size_t>(i)]; }
    int first_in(int row, int column) const { return first_[cell(row, column)]; }

    /// The row or column of a position along its axis.
    int along(Real position) const {
        const Real scaled = position / cell_side_;
        return scaled > 0 ? static_cast<int>(std::min(scaled, static_cast<Real>(per_side_ - 1))) : 0;
    }

    void insert(int i, int row, int column) {
        int& first = first_[cell(row, column)];
        at(i) = {.row = row, .column = column, .next = first};
        if (first != none) {
            at(first).previous = i;
        }
        first = i;
    }

    void remove(int i) {
        const Place& one = place(i);
        if (one.previous == none) {
            first_[cell(one.row, one.column)] = one.next;
        } else {
            at(one.previous).next = one.next;
        }
        if (one.next != none) {
            at(one.next).previous = one.previous;
        }
    }

    /// How long until a disc in this row or column leaves it along its axis; never for a cell that is not
    /// there.
    Real time_to_crossing(Real position, Real velocity, int index) const {
        const int edge = velocity > 0 ? index + 1 : index;
        if (velocity == 0 || edge == 0 || edge == per_side_) {
            return std::numeric_limits<Real>::infinity();
        }
        return std::max((static_cast<Real>(edge) * cell_side_ - position) / velocity, Real(0));
    }

  private:
    std::size_t cell(int row, int column) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(per_side_) +
               static_cast<std::size_t>(column);
    }
    Place& at(int i) { return places_[static_cast<std::size_t>(i)]; }

    Real cell_side_;
    int per_side_;
    std::vector<Place> places_;
    std::vector<int> first_;
};

} // namespace carom
