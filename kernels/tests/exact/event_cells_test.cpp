#include <algorithm>
#include <cmath>
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

TEST(EventCells, HoldAPositionBetweenTheirEdgesAndReachOutToInfinity) {
    const Scene scene = random_scene(100, 50, 2, 0, 1, 7);
    const EventCells<double> cells = cells_of(scene);
    Random random(8);
    for (int k = 0; k < 1000; ++k) {
        const double x = random.uniform(-30, 80);
        const double y = random.uniform(-30, 80);
        const int cell = cells.cell_at(x, y);
        EXPECT_LE(cells.edge_x(cell, false), x);
        EXPECT_GE(cells.edge_x(cell, true), x);
        EXPECT_LE(cells.edge_y(cell, false), y);
        EXPECT_GE(cells.edge_y(cell, true), y);
        EXPECT_EQ(cells.edge_x(cell + cells.stride(), false), cells.edge_x(cell, false)) << "the next row";
    }
    const int last = cells.cell_at(1e9, 1e9);
    EXPECT_EQ(cells.edge_x(last, true), infinity);
    EXPECT_EQ(cells.edge_y(last, true), infinity);
    EXPECT_LT(cells.edge_x(last, false), 50);
    EXPECT_EQ(cells.edge_x(cells.cell_at(-1e9, 25), false), -infinity);
}

/// Whoever is within 2r of a disc is in one of the nine cells, whose numbers exist even at a corner.
TEST(EventCells, NineOfThemHoldAllWithinADiameter) {
    const Scene scene = random_scene(200, 40, 1, 0, 1, 9);
    EventCells<double> cells = cells_of(scene);
    for (std::size_t i = 0; i < scene.discs.size(); ++i) {
        cells.insert(static_cast<int>(i), cells.cell_at(scene.discs[i].x, scene.discs[i].y));
    }
    int pairs = 0;
    for (const Disc& one : scene.discs) {
        std::vector<bool> near(scene.discs.size());
        for (const int offset : cells.nine()) {
            const int cell = cells.cell_at(one.x, one.y) + offset;
            ASSERT_GE(cell, 0);
            ASSERT_LT(cell, cells.stride() * cells.stride());
            for (const int disc : discs_in(cells, cell)) {
                near[static_cast<std::size_t>(disc)] = true;
            }
        }
        for (std::size_t j = 0; j < scene.discs.size(); ++j) {
            const Disc& other = scene.discs[j];
            const double distance = std::hypot(other.x - one.x, other.y - one.y);
            EXPECT_TRUE(near[j] || distance > 2 * scene.radius);
            pairs += distance <= 2 * scene.radius ? 1 : 0;
        }
    }
    EXPECT_GT(pairs, 500);
}

} // namespace
} // namespace carom::tests
