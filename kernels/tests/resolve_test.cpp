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

TEST(EveryOther, CountsIndicesOfOneParity) {
    for (int count = 0; count < 10; ++count) {
        for (const int first : {0, 1}) {
            int expected = 0;
            for (int i = first; i < count; i += 2) {
                ++expected;
            }
            EXPECT_EQ(every_other(count, first), expected) << count << " from " << first;
        }
    }
}

/// Says which boxes of the grid a sweep visits, by what a probe is told.
template <Policies policies> Tally sweep_of(State<policies>& state, int threads) {
    NoProbe probe;
    const Tuning tuning{.threads = threads};
    const ApproachTolerance approaching(tuning.tolerance);
    if constexpr (policies.order == Order::checkered) {
        return sweep_checkered(state, tuning, approaching, probe).work;
    } else if constexpr (policies.order == Order::wavefront) {
        Wavefront wavefront(state.grid.strip_count(strip_height(policies.order)));
        return sweep_wavefront(state, wavefront, 0, 1, false, tuning, approaching, probe).work;
    } else {
        return sweep_strips(state, tuning, approaching, probe).work;
    }
}

/// A disc in each box of a grid with an odd or even number of rows meets its own partner: one sweep resolves
/// all.
template <Order order> void one_sweep_reaches_every_box() {
    for (const int boxes : {1, 2, 3, 6, 7}) {
        SCOPED_TRACE(boxes);
        Scene scene{.side = 5.0 * boxes, .radius = 1, .steps = 1, .discs = {}};
        for (int row = 0; row < boxes; ++row) {
            for (int column = 0; column < boxes; ++column) {
                scene.discs.push_back({5.0 * column + 1.5, 5.0 * row + 2.5, 0.25, 0});
                scene.discs.push_back({5.0 * column + 3.5, 5.0 * row + 2.5, -0.125, 0});
            }
        }
        State state = with_overlaps<Policies{
            .order = order, .self_contained = SelfContained::off, .resolve_schedule = Schedule::dynamic}>(
            scene);
        ASSERT_EQ(state.grid.boxes_per_side(), boxes);
        EXPECT_EQ(sweep_of(state, 2).pair_resolves, boxes * boxes);
        EXPECT_FALSE(sweep_of(state, 2).changed());
    }
}

TEST(CheckeredOrder, ReachesEveryBoxInASweep) { one_sweep_reaches_every_box<Order::checkered>(); }
TEST(RowOrder, ReachesEveryBoxInASweep) { one_sweep_reaches_every_box<Order::row>(); }
TEST(StripsOrder, ReachesEveryBoxInASweep) { one_sweep_reaches_every_box<Order::strips>(); }
TEST(WavefrontOrder, ReachesEveryBoxInASweep) { one_sweep_reaches_every_box<Order::wavefront>(); }

/// Three discs in a row: the first runs into the second, which passes the blow on to the third.
template <Order order = Order::checkered, Direction direction = Direction::reverse> auto chain() {
    return with_overlaps<Policies{
        .order = order, .self_contained = SelfContained::off, .direction = direction}>(
        {.side = 50, .radius = 1, .steps = 1, .discs = {{20, 27, 1, 0}, {22.5, 27, 0, 0}, {24, 27, 0, 0}}});
}

TEST(Direction, DecidesWhichPartnerComesFirst) {
    State forward = chain<Order::checkered, Direction::forward>();
    State reverse = chain();
    const ApproachTolerance approaching(Tolerance::relative);
    std::vector<int> changed;
    const auto note = [&changed](int j) { changed.push_back(j); };
    // Disc 1 is listed with 0 and then 2; only after the blow from 0 has it anything to pass on to 2.
    ASSERT_EQ(forward.overlaps[1], (std::vector<int>{0, 2}));
    visit<false, Direction::forward>(forward, 1, false, approaching, note);
    EXPECT_EQ(changed, (std::vector<int>{0, 2}));
    changed.clear();
    visit<false, Direction::reverse>(reverse, 1, false, approaching, note);
    EXPECT_EQ(changed, (std::vector<int>{0}));
}

template <Order order> Tally resolve_chain() {
    State state = chain<order>();
    NoProbe probe;
    const Tally tally = resolve(state, {}, probe);
    EXPECT_EQ(state.discs[0].vx, 0);
    EXPECT_EQ(state.discs[1].vx, 0);
    EXPECT_EQ(state.discs[2].vx, 1);
    return tally;
}

TEST(Once, PassesOncePerDiscAndSweep) { EXPECT_EQ(resolve_chain<Order::once>().pair_resolves, 2); }

TEST(Track, EndsWithoutASweepOverEverything) {
    // All three are visited; disc 0 changes 1 before it is visited, 1 changes 2 likewise: nothing is left
    // pending.
    EXPECT_EQ(resolve_chain<Order::track>().sweeps, 1);
    EXPECT_EQ(resolve_chain<Order::repeat>().sweeps, 2);
}

} // namespace
} // namespace carom
