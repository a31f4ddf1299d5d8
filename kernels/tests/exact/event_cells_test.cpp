#include <algorithm>
#include <cstddef>
#include <limits>
#include <list>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/exact/event_cells.hpp"
#include "kernels/tests/exact/cells_of.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom::tests {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The discs of a cell, the latest first.
std::vector<int> discs_in(const EventCells<double>& cells, int cell) {
    std::vector<int> discs;
    for (int k = 0; k < cells[cell].count; ++k) {
        discs.push_back(k < cells.at_hand ? cells[cell].discs[static_cast<std::size_t>(k)]
                                          : cells.before(discs.back()));
    }
    return discs;
}

TEST(EventCells, HoldWhatListsWouldHoldFromNoneToManyDiscsInACell) {
    constexpr int count = 60;
    const Scene scene = random_scene(count, 10, 1.2, 0, 1, 5);
    EventCells<double> cells = cells_of(scene);
    const int all = cells.stride() * cells.stride();
    std::vector<std::list<int>> lists(static_cast<std::size_t>(all));
    std::vector<int> cell_of(count, -1);
    Random random(6);
    const auto list = [&](int cell) -> std::list<int>& { return lists[static_cast<std::size_t>(cell)]; };
    std::size_t longest = 0;
    for (int change = 0; change < 20'000; ++change) {
        const int disc = random.below(count);
        int& cell = cell_of[static_cast<std::size_t>(disc)];
        if (cell >= 0) {
            cells.remove(disc, cell);
            list(cell).remove(disc);
            cell = -1;
        } else {
            cell = cells.cell_at(random.uniform(0, 10), random.magnitude(-2, 1));
            cells.insert(disc, cell);
            list(cell).push_front(disc);
            longest = std::max(longest, list(cell).size());
        }
        const int looked_at = random.below(all);
        const std::list<int>& expected = list(looked_at);
        ASSERT_EQ(discs_in(cells, looked_at), std::vector<int>(expected.begin(), expected.end()));
    }
    EXPECT_GT(longest, 8);
}

} // namespace
} // namespace carom::tests
