#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/exact/event_driven.hpp"
#include "kernels/exact/event_windows.hpp"
#include "kernels/exact/tiles_for.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom::tests {
namespace {

struct LastState {
    std::vector<Disc> discs;
    std::int64_t pair_collisions;
    std::int64_t wall_collisions;
    double wall_impulse;
    std::array<double, 2> momentum_from_walls;
    bool operator==(const LastState&) const = default;
};

template <class Simulation> LastState last_state(const Simulation& simulation) {
    return {simulation.discs(), simulation.pair_collisions(), simulation.wall_collisions(),
            simulation.wall_impulse(), simulation.momentum_from_walls()};
}

LastState in_order(const Scene& scene, double time) {
    EventDriven<double> simulation(scene);
    EXPECT_TRUE(simulation.advance(time));
    return last_state(simulation);
}

struct InWindows {
    LastState last;
    std::int64_t windows;
    std::int64_t repeated;
};

/// Goes on to the time in `looks` equal parts.
InWindows in_windows(const Scene& scene, double time, int threads, const WindowSettings& settings,
                     int looks = 1) {
    EventWindows<double> simulation(scene, threads, settings);
    for (int look = 1; look <= looks; ++look) {
        EXPECT_TRUE(simulation.advance(time * look / looks));
    }
    return {last_state(simulation), simulation.windows(), simulation.repeated()};
}

struct Case {
    std::string name;
    Scene scene;
    double time;
};

Scene a_fast_one_among_slow_ones() {
    Scene scene = lattice_scene(30, 0.2, 4);
    scene.discs[17].vx = 300;
    scene.discs[450].vy = -200;
    return scene;
}

Scene at_rest_but_one() {
    Scene scene = lattice_scene(30, 0.4, 5);
    for (std::size_t i = 1; i < scene.discs.size(); ++i) {
        scene.discs[i].vx = scene.discs[i].vy = 0;
    }
    return scene;
}

/// A blow is handed on at one instant, from higher numbers to lower ones and from tile to tile.
Scene touching() {
    return {.side = 20,
            .radius = 1,
            .steps = 0,
            .discs = {{14, 10, 0, 0}, {12, 10, 0, 0}, {10, 10, 0, 0}, {8, 10, 0, 0}, {4, 10, 1, 0}}};
}

std::vector<Case> cases() {
    return {{"nothing", {.side = 10, .radius = 1, .steps = 0, .discs = {}}, 5},
            {"one disc", {.side = 10, .radius = 1, .steps = 0, .discs = {{5, 5, 2, 1}}}, 30},
            {"cradle", cradle(), 20},
            {"touching", touching(), 20},
            {"from outside", outside(), 9},
            {"tied", tied_scene(24), 8},
            {"a fast one", a_fast_one_among_slow_ones(), 2},
            {"at rest but one", at_rest_but_one(), 50},
            {"0.01", lattice_scene(25, 0.01, 6), 60},
            {"0.1", lattice_scene(30, 0.1, 7), 20},
            {"0.4", lattice_scene(40, 0.4, 8), 6},
            {"0.7", lattice_scene(40, 0.7, 9), 3}};
}

/// From tiles that are far too small for their halo to the whole box.
TEST(EventWindows, EndInTheSameBitsForAnyTilesAndThreads) {
    for (const auto& [name, scene, time] : cases()) {
        const LastState expected = in_order(scene, time);
        for (const TileCounts& tiles :
             {TileCounts{}, TileCounts{2, 1}, TileCounts{1, 3}, TileCounts{3, 3}, TileCounts{7, 7}}) {
            for (const int threads : tiles.all() == 9 ? std::vector{1, 2, 3, 8, 64} : std::vector{2}) {
                const InWindows found = in_windows(scene, time, threads, {.tiles = tiles});
                EXPECT_TRUE(found.last == expected) << name << ", " << tiles.all() << " tiles, " << threads;
            }
        }
    }
}

TEST(EventWindows, EndInTheSameBitsForAnyHaloAndLengthAndHoweverOftenOneLooks) {
    struct Shared {
        double halo;
        double collisions_per_disc;
        int looks;
    };
    for (const auto& [name, scene, time] : cases()) {
        const LastState expected = in_order(scene, time);
        for (const auto& [halo, collisions, looks] :
             {Shared{0, 0.5, 1}, Shared{3, 0.1, 7}, Shared{30, 20, 1}, Shared{0, 20, 7}}) {
            const WindowSettings settings{
                .tiles = {3, 3}, .halo = halo, .halo_paths = 0, .collisions_per_disc = collisions};
            EXPECT_TRUE(in_windows(scene, time, 2, settings, looks).last == expected)
                << name << ", halo " << halo << ", " << collisions << " collisions, " << looks;
        }
    }
}

/// A halo that is too narrow is noticed: more of the windows have to be done again than with a wide one.
TEST(EventWindows, NoticeThatTilesDisagree) {
    const Scene scene = lattice_scene(60, 0.6, 3);
    const WindowSettings narrow{.tiles = {3, 3}, .halo = 0, .halo_paths = 0, .widen = 1, .narrow = 1};
    const WindowSettings wide{.tiles = {3, 3}, .halo = 14, .halo_paths = 0, .widen = 1, .narrow = 1};
    EXPECT_GT(in_windows(scene, 3, 2, narrow).repeated, 3);
    EXPECT_EQ(in_windows(scene, 3, 2, wide).repeated, 0);
    EXPECT_GT(in_windows(scene, 3, 2, wide).windows, 3);
}

TEST(EventWindows, SayThatCollisionsOfAnInstantDoNotEnd) {
    const Scene wedged{.side = 2, .radius = 1, .steps = 0, .discs = {{1, 1, 1, 0}}};
    EventWindows<double> simulation(wedged, 2, {.tiles = {2, 2}});
    EXPECT_FALSE(simulation.advance(1, {.at_once = 1000}));
}

TEST(EventWindows, AreCutWhereThatPays) {
    EXPECT_EQ(tiles_for(0, 64), TileCounts{});
    EXPECT_EQ(tiles_for(2'000, 64), TileCounts{});
    EXPECT_EQ(tiles_for(2'000, 2), TileCounts{});
    EXPECT_EQ(tiles_for(4'000, 2), (TileCounts{2, 1}));
    EXPECT_EQ(tiles_for(20'000, 2), (TileCounts{2, 1}));
    EXPECT_EQ(tiles_for(20'000, 16), (TileCounts{4, 4}));
    EXPECT_EQ(tiles_for(100'000, 1), TileCounts{});
    EXPECT_EQ(tiles_for(100'000, 3), (TileCounts{3, 1}));
    EXPECT_EQ(tiles_for(100'000, 4), (TileCounts{2, 2}));
    EXPECT_EQ(tiles_for(100'000, 8), (TileCounts{4, 2})) << "not 3 x 3, of which one thread would have two";
    EXPECT_EQ(tiles_for(1'000'000, 1), (TileCounts{4, 4}));
    EXPECT_EQ(tiles_for(1'000'000, 64), (TileCounts{8, 8}));
    EXPECT_NEAR(tiles_for(100'000'000, 1).all(), 100'000'000 / 63'000, 100);
}

TEST(EventWindows, BeginAnew) {
    const Scene scene = lattice_scene(30, 0.5, 2);
    EventWindows<double> simulation(scene, 2, {.tiles = {2, 2}});
    EXPECT_TRUE(simulation.advance(2));
    const std::vector<Disc> first = simulation.discs();
    simulation.restart(scene);
    EXPECT_EQ(simulation.discs(), scene.discs);
    EXPECT_TRUE(simulation.advance(2));
    EXPECT_EQ(simulation.discs(), first);
}

} // namespace
} // namespace carom::tests
