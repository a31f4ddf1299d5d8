#include <algorithm>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/find.hpp"
#include "kernels/move.hpp"
#include "kernels/resolve.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::all_scenes;
using tests::Random;

template <Policies policies = Policies{.self_contained = SelfContained::off}>
State<policies> with_overlaps(const Scene& scene) {
    State<policies> state(scene);
    NoProbe probe;
    move(state, {}, probe);
    bin(state, {}, probe);
    find(state, {}, probe);
    return state;
}

/// For every disc, the one group in which it is touched; fails the test if two groups touch it.
template <Policies policies, class GroupOf>
void every_disc_is_touched_by_one_group_at_most(const State<policies>& state, const GroupOf& group_of) {
    constexpr int untouched = -1;
    std::vector<int> toucher(state.discs.size(), untouched);
    const auto touch = [&toucher](int disc, int group) {
        int& first = toucher[static_cast<std::size_t>(disc)];
        ASSERT_TRUE(first == untouched || first == group)
            << "disc " << disc << " is touched by groups " << first << " and " << group;
        first = group;
    };
    for (int i = 0; i < state.count(); ++i) {
        const auto& disc = state.discs[static_cast<std::size_t>(i)];
        const int group = group_of(state.grid.coordinate(disc.y), state.grid.coordinate(disc.x));
        if (group < 0) {
            continue;
        }
        touch(i, group);
        for (const int j : state.overlaps[static_cast<std::size_t>(i)]) {
            touch(j, group);
        }
    }
}

/// Discs in every corner and at every edge of the grid's boxes, so that partners lie as far away as they can.
Scene crowd_at_box_edges(double radius, std::uint64_t seed) {
    Random random(seed);
    const Grid grid(20 * (4 * radius + 1), radius);
    Scene scene{.side = 20 * (4 * radius + 1), .radius = radius, .steps = 1, .discs = {}};
    for (int i = 0; i < 2000; ++i) {
        const double step = grid.box_side() / 2;
        const auto near_an_edge = [&] {
            const double off = std::max(grid.box_side() - 4 * radius, 1e-12 * radius);
            return random.below(41) * step + random.uniform(-1, 1) * off;
        };
        const double x = near_an_edge();
        scene.discs.push_back({x, near_an_edge(), 0, 0});
    }
    return scene;
}

std::vector<tests::NamedScene> scenes_with_crowds() {
    std::vector<tests::NamedScene> scenes = all_scenes();
    for (const double radius : {0.1, 1.0, 1e3, 1e6, 1e12, 1e40}) {
        scenes.push_back({"crowd of radius " + std::to_string(radius), crowd_at_box_edges(radius, 61)});
    }
    return scenes;
}

TEST(CheckeredOrder, NeverTouchesADiscFromTwoBoxesOfOneColour) {
    for (const auto& [name, scene] : scenes_with_crowds()) {
        SCOPED_TRACE(name);
        const State state = with_overlaps(scene);
        for (const int colour : {0, 1, 2, 3}) {
            every_disc_is_touched_by_one_group_at_most(state, [&](int row, int column) {
                return 2 * (row % 2) + column % 2 == colour ? state.grid.box_of(row, column) : -1;
            });
        }
    }
}

TEST(RowOrder, NeverTouchesADiscFromTwoRowsOfOneParity) {
    for (const auto& [name, scene] : scenes_with_crowds()) {
        SCOPED_TRACE(name);
        const State state = with_overlaps(scene);
        for (const int parity : {0, 1}) {
            every_disc_is_touched_by_one_group_at_most(
                state, [&](int row, int /*column*/) { return row % 2 == parity ? row : -1; });
        }
    }
}

} // namespace
} // namespace carom
