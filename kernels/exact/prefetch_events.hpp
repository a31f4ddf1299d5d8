#pragma once

#include <array>
#include <vector>

#include "kernels/exact/event_cells.hpp"
#include "kernels/exact/event_queue.hpp"
#include "kernels/exact/flight.hpp"

namespace carom {

/// Asks the memory for what the next events of the exact simulation will read. Each thing must have arrived
/// for the next to be known, so that it takes as many events: the disc; its cells and its partner; who is in
/// its cells, and the cells of its partner; who is in those. No result depends on it.
template <class Real> class PrefetchEvents {
  public:
    PrefetchEvents(const std::vector<Flight<Real>>& flights, const EventCells<Real>& cells,
                   const std::array<int, 9>& nine)
        : flights_(flights), cells_(cells), nine_(nine) {}

    [[gnu::always_inline]] void what_comes(const EventQueue<Real>& queue) const {
        __builtin_prefetch(&flight(queue.coming(3)));
        const Flight<Real>& third = flight(queue.coming(2));
        around(third.cell);
        if (third.partner >= 0) {
            __builtin_prefetch(&flight(third.partner));
            queue.prefetch(third.partner);
        }
        const Flight<Real>& second = flight(queue.coming(1));
        discs_around(second.cell);
        if (second.partner >= 0) {
            around(flight(second.partner).cell);
        }
        const Flight<Real>& first = flight(queue.coming(0));
        if (first.partner >= 0) {
            discs_around(flight(first.partner).cell);
        }
    }

  private:
    const Flight<Real>& flight(int i) const { return flights_[static_cast<std::size_t>(i)]; }

    [[gnu::always_inline]] void around(int cell) const {
        for (const int middle : {cell - cells_.stride(), cell, cell + cells_.stride()}) {
            __builtin_prefetch(&cells_[middle - 1]);
            __builtin_prefetch(&cells_[middle + 1]);
        }
    }

    [[gnu::always_inline]] void discs_around(int cell) const {
        for (const int offset : nine_) {
            __builtin_prefetch(&flight(cells_[cell + offset].discs[0]));
            __builtin_prefetch(&flight(cells_[cell + offset].discs[1]));
        }
    }

    const std::vector<Flight<Real>>& flights_;
    const EventCells<Real>& cells_;
    const std::array<int, 9>& nine_;
};

} // namespace carom
