#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/step.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

// Impact::at_contact with lists: what is near, who collides, and that it is the same as with contacts.

namespace carom {
namespace {

using tests::Random;
using tests::same_bits;

constexpr Policies lists{.impact = Impact::at_contact};
constexpr Policies contacts{.neighbourhood = Neighbourhood::nine,
                            .order = Order::wavefront,
                            .self_contained = SelfContained::off,
                            .resolve_schedule = Schedule::dynamic,
                            .storage = Storage::sorted,
                            .box_side = BoxSide::snug,
                            .overlaps = Overlaps::contacts,
                            .search = Search::filtered,
                            .worklist = Worklist::active,
                            .impact = Impact::at_contact};

constexpr Policies in_float(Policies policies) {
    policies.precision = Precision::float_;
    return policies;
}

/// Discs of radius 1, none of which overlaps another at the start: a square lattice, each disc somewhere in
/// the gap around its place.
Scene scene_apart(int per_side, double area_fraction, int steps, double speed, std::uint64_t seed) {
    const double spacing = std::sqrt(std::numbers::pi / area_fraction);
    Random random(seed);
    Scene scene{.side = per_side * spacing, .radius = 1, .steps = steps, .discs = {}};
    for (int i = 0; i < per_side * per_side; ++i) {
        const auto place = [&](int k) {
            return (k + 0.5) * spacing + random.uniform(-1, 1) * (spacing / 2 - 1);
        };
        const double x = place(i % per_side);
        const double y = place(i / per_side);
        const double vx = random.uniform(-speed, speed);
        scene.discs.push_back({x, y, vx, random.uniform(-speed, speed)});
    }
    return scene;
}

template <Policies policies> Tally found(State<policies>& state, const Tuning& tuning = {}) {
    NoProbe probe;
    move(state, tuning, probe);
    bin(state, tuning, probe);
    return find(state, tuning, probe);
}

/// A step up to where what is left is to be resolved in place.
template <Policies policies> Tally collided(State<policies>& state, const Tuning& tuning) {
    NoProbe probe;
    Tally tally = found(state, tuning);
    tally += collide_at_contact(state, tuning, probe);
    tally.pair_attempts = 0; // a pair stands in two lists and is one contact
    return tally;
}

template <Policies policies> std::int64_t resolve_what_is_left(State<policies>& state, const Tuning& tuning) {
    NoProbe probe;
    Tally work = find_left(state, tuning, probe);
    work += resolve_in_place(state, tuning, probe);
    return work.pair_resolves + work.wall_resolves;
}

struct Collisions {
    std::int64_t at_contact = 0;
    std::int64_t in_place = 0;
};

/// Goes through a scene with two kinds of storage. In each step both begin with the same discs and must come
/// to the same, to the last bit and with as much work, when collisions at contact are made. What is left then
/// is resolved by the first one alone: in place there are several orders.
template <Policies one, Policies two> Collisions collisions_alike(const Scene& scene, const Tuning& tuning) {
    State<one> state(scene);
    State<two> other(scene);
    Collisions collisions;
    for (int step = 1; step <= scene.steps * tuning.substeps; ++step) {
        SCOPED_TRACE("step " + std::to_string(step));
        const Tally work = collided(state, tuning);
        EXPECT_EQ(collided(other, tuning), work);
        const auto same = same_bits(discs_by_number(other), discs_by_number(state));
        EXPECT_TRUE(same);
        if (!same) {
            return collisions;
        }
        collisions.at_contact += work.pair_resolves + work.wall_resolves;
        collisions.in_place += resolve_what_is_left(state, tuning);
        for (int i = 0; i < other.count(); ++i) {
            other.discs[static_cast<std::size_t>(i)] = state.discs[static_cast<std::size_t>(other.number(i))];
        }
    }
    return collisions;
}

/// In none of these does a disc have two collisions at one instant, to the last bit: of these each storage
/// makes another one first.
TEST(CollisionsAtContact, AreTheSameWithListsAndWithContactsInEveryScene) {
    for (const auto& [name, scene] : tests::all_scenes()) {
        SCOPED_TRACE(name);
        collisions_alike<lists, contacts>(scene, {});
        collisions_alike<lists, contacts>(scene, {.threads = 3, .substeps = 4});
    }
}

TEST(CollisionsAtContact, AreTheSameWithListsAndWithContactsAtEveryDensity) {
    for (const double area_fraction : {0.10, 0.40, 0.65}) {
        SCOPED_TRACE(area_fraction);
        const Scene scene = scene_apart(40, area_fraction, 8, 0.35, 31);
        const auto least = static_cast<std::int64_t>(1500 * area_fraction);
        for (const int substeps : {1, 2, 8}) {
            const Tuning tuning{.threads = 2, .substeps = substeps};
            const Collisions exact = collisions_alike<lists, contacts>(scene, tuning);
            EXPECT_GT(exact.at_contact, least);
            EXPECT_LT(exact.in_place, exact.at_contact / (substeps == 1 ? 5 : 20));
            const Collisions rounded = collisions_alike<in_float(lists), in_float(contacts)>(scene, tuning);
            EXPECT_GT(rounded.at_contact, least);
        }
    }
}

/// The order of what is left has no say in what collides at contact, nor has who looks into which boxes.
TEST(CollisionsAtContact, AreTheSameWithEveryOrderAndNeighbourhood) {
    const Scene scene = scene_apart(20, 0.65, 8, 0.35, 32);
    constexpr Policies nine_in_rows{.neighbourhood = Neighbourhood::nine,
                                    .order = Order::row,
                                    .self_contained = SelfContained::off,
                                    .direction = Direction::forward,
                                    .impact = Impact::at_contact};
    constexpr Policies sorted_strips{.order = Order::strips,
                                     .find_schedule = Schedule::dynamic,
                                     .storage = Storage::sorted,
                                     .impact = Impact::at_contact};
    constexpr Policies track{.order = Order::track, .impact = Impact::at_contact};
    EXPECT_GT((collisions_alike<lists, nine_in_rows>(scene, {}).at_contact), 200);
    EXPECT_GT((collisions_alike<lists, sorted_strips>(scene, {}).at_contact), 200);
    EXPECT_GT((collisions_alike<lists, track>(scene, {}).at_contact), 200);
}

/// Every disc's near ones and, if it is near a wall, itself, by looking at all pairs.
std::vector<std::multiset<int>> near_by_brute_force(const Scene& scene, const std::vector<Disc>& discs,
                                                    double radius) {
    std::vector<std::multiset<int>> near(discs.size());
    for (std::size_t i = 0; i < discs.size(); ++i) {
        for (std::size_t j = 0; j < discs.size(); ++j) {
            const double dx = discs[i].x - discs[j].x;
            const double dy = discs[i].y - discs[j].y;
            if (i == j ? overlaps_wall(discs[i], scene.side, radius)
                       : dx * dx + dy * dy <= 2 * radius * (2 * radius)) {
                near[i].insert(static_cast<int>(j));
            }
        }
    }
    return near;
}

/// Discs as large as the published ones, whose boxes would not hold the wider reach if they were as
/// published.
Scene large_discs() { return tests::scaled(scene_apart(15, 0.65, 4, 0.5, 33), 16, 16); }

template <Policies policies> void finds_what_is_near() {
    auto scenes = tests::all_scenes();
    scenes.push_back({"large discs", large_discs()});
    for (const auto& [name, scene] : scenes) {
        SCOPED_TRACE(name);
        State<policies> state(scene);
        const Tally tally = found(state, {.threads = 3});
        const std::vector<Disc> discs = discs_by_number(state);
        const double radius = std::min(scene.radius + state.speed / 2, 1.125 * scene.radius);
        const auto expected = near_by_brute_force(scene, discs, radius);
        const auto overlapping = near_by_brute_force(scene, discs, scene.radius);
        std::int64_t overlaps = 0;
        for (std::size_t i = 0; i < discs.size(); ++i) {
            std::multiset<int> near;
            for (const auto& one : state.near[i]) {
                near.insert(one.other);
            }
            EXPECT_EQ(near, expected[i]) << i;
            overlaps += static_cast<std::int64_t>(overlapping[i].size()) -
                        overlaps_wall(discs[i], scene.side, scene.radius);
        }
        EXPECT_EQ(2 * tally.overlaps, overlaps);
    }
}

TEST(NearDiscs, AreAllWithinTheSearchRadius) { finds_what_is_near<lists>(); }

TEST(NearDiscs, AreAllWithinTheSearchRadiusInNineBoxes) {
    finds_what_is_near<Policies{.neighbourhood = Neighbourhood::nine, .impact = Impact::at_contact}>();
}

/// What is left in the lists is what was near and overlaps now, of the own box first.
TEST(OverlapsLeft, AreWhatIsNearAndOverlaps) {
    const Scene scene = scene_apart(20, 0.65, 1, 0.7, 34);
    State<lists> state(scene);
    collided(state, {});
    NoProbe probe;
    find_left(state, {}, probe);
    const auto overlapping = near_by_brute_force(scene, state.discs, scene.radius);
    int left = 0;
    for (std::size_t i = 0; i < state.discs.size(); ++i) {
        std::multiset<int> expected;
        for (const auto& near : state.near[i]) {
            if (near.other != static_cast<int>(i) && overlapping[i].contains(near.other)) {
                expected.insert(near.other);
            }
        }
        EXPECT_EQ(std::multiset<int>(state.overlaps[i].begin(), state.overlaps[i].end()), expected) << i;
        left += static_cast<int>(expected.size());
    }
    EXPECT_GT(left, 10);
}

/// A blow goes through three in a row, beside a pair at rest. At first all six entries of lists are asked;
/// then, after each of the two collisions, the four of the three.
TEST(CollisionsAtContact, AskAgainOnlyWhoIsNearOne) {
    const Scene scene{
        .side = 30,
        .radius = 1,
        .steps = 1,
        .discs = {
            {10, 10, 1, 0}, {12.25, 10, 0, 0}, {14.375, 10, 0, 0}, {10, 20, 0, 0}, {12.0625, 20, 0, 0}}};
    State<lists> state(scene);
    NoProbe probe;
    Tally work = found(state);
    work += collide_at_contact(state, {}, probe);
    EXPECT_EQ(work.pair_resolves, 2);
    EXPECT_EQ(work.pair_attempts, 6 + 4 + 4);
}

/// One disc pushes another into a wall that this was not near: it stays in there, still moving into it. The
/// next step follows it back to when it met the wall, a step ago.
template <Policies policies> void leaves_to_the_next_step_who_is_pushed_into_a_wall() {
    Scene scene{.side = 20, .radius = 1, .steps = 1, .discs = {{10, 1.625, 0, 0}, {10, 3.875, 0, -1}}};
    EXPECT_EQ(tests::simulate<policies>(scene).discs[0], (Disc{10, 0.875, 0, -1}));
    scene.steps = 2;
    EXPECT_EQ(tests::simulate<policies>(scene).discs[0], (Disc{10, 2.125, 0, 1}));
}

TEST(CollisionsAtContact, LeaveToTheNextStepWhoIsPushedIntoAWall) {
    leaves_to_the_next_step_who_is_pushed_into_a_wall<lists>();
    leaves_to_the_next_step_who_is_pushed_into_a_wall<contacts>();
}

/// A disc strikes two at one instant. Of its speed the first gets 3/4 along its path, and the second less.
TEST(CollisionsAtOneInstant, AreMadeWithTheLowestDiscFirst) {
    const Disc striker{10, 10, 1, 0};
    const Disc upper{12.25, 11, 0, 0};
    const Disc lower{12.25, 9, 0, 0};
    const auto expect_first = [](std::size_t first, const std::vector<Disc>& discs) {
        const auto after =
            tests::simulate<lists>({.side = 20, .radius = 1, .steps = 1, .discs = discs}).discs;
        EXPECT_NEAR(after[first].vx, 0.75, 1e-15);
        EXPECT_LT(after[2].vx, 0.5);
    };
    expect_first(1, {striker, upper, lower});
    expect_first(1, {striker, lower, upper});
    expect_first(0, {upper, striker, lower});
    expect_first(0, {lower, striker, upper});
}

/// Four discs meet in a square, each with two others at one instant: every choice is one between equals, and
/// yet some pair chooses each other until none is left to, however they are numbered.
TEST(CollisionsAtOneInstant, ComeToAnEnd) {
    std::vector<Disc> corners;
    for (const auto& [x, y] : {std::pair{1.0, 1.0}, {1.0, -1.0}, {-1.0, -1.0}, {-1.0, 1.0}}) {
        corners.push_back({10 + 1.5 * x, 10 + 1.5 * y, -0.75 * x, -0.75 * y});
    }
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    do {
        Scene square{.side = 20, .radius = 1, .steps = 1, .discs = {}};
        for (const std::size_t i : order) {
            square.discs.push_back(corners[i]);
        }
        State<lists> state(square);
        const Tally work = collided(state, {});
        EXPECT_GE(work.pair_resolves, 4);
        EXPECT_LT(work.sweeps, most_sweeps_at_contact);
        for (const auto& next : state.next) {
            EXPECT_LT(next.other, 0);
        }
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Disc& corner = corners[order[i]];
            const Disc back{corner.x, corner.y, -corner.vx, -corner.vy};
            EXPECT_NEAR(state.discs[i].vx, back.vx, 1e-15);
            EXPECT_NEAR(state.discs[i].vy, back.vy, 1e-15);
        }
    } while (std::ranges::next_permutation(order).found);
}

} // namespace
} // namespace carom
