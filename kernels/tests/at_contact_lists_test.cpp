#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/step.hpp"
#include "kernels/tests/fast_policies.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

// Impact::at_contact with lists: what is near, who collides, and that it is the same as with contacts.

namespace carom {
namespace {

using tests::Random;
using tests::same_bits;

constexpr Policies lists{.impact = Impact::at_contact};
constexpr Policies contacts = tests::at_contact(tests::fastest);
constexpr Policies in_float(const Policies& policies) {
    return tests::with(policies, &Policies::precision, Precision::float_);
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

/// So many discs that later sweeps, too, change enough to run on all threads.
TEST(CollisionsAtContact, DependOnNoThreadInManySweeps) {
    constexpr Policies policies{.find_schedule = Schedule::dynamic_chunk,
                                .resolve_schedule = Schedule::dynamic_chunk,
                                .impact = Impact::at_contact};
    const Scene scene = tests::random_scene_of_density(8000, 0.8, 2, 83);
    const tests::Outcome expected = tests::simulate<policies>(scene, {.threads = 1});
    ASSERT_GT(expected.work.pair_resolves, 16 * few_changes);
    for (const int threads : {2, 3, 8}) {
        for (const int chunk : {1, 5}) {
            SCOPED_TRACE(testing::Message() << threads << " threads, chunks of " << chunk);
            const auto found = tests::simulate<policies>(
                scene, {.threads = threads, .find_chunk = chunk, .resolve_chunk = chunk});
            EXPECT_TRUE(same_bits(found.discs, expected.discs));
            EXPECT_EQ(found.work, expected.work);
        }
    }
}

} // namespace
} // namespace carom
