#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/step.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

// Impact::at_contact with lists: what is free to differ, and is fixed. That the collisions are right is
// proven by harness/collisions/, whose mutants lose it here.

namespace carom {
namespace {

using tests::same_bits;

/// A disc strikes two at one instant. Of its speed the first gets 3/4 along its path, and the second less.
TEST(CollisionsAtOneInstant, AreMadeWithTheLowestDiscFirst) {
    const Disc striker{10, 10, 1, 0};
    const Disc upper{12.25, 11, 0, 0};
    const Disc lower{12.25, 9, 0, 0};
    const auto expect_first = [](std::size_t first, const std::vector<Disc>& discs) {
        const auto after = tests::simulate<Policies{.impact = Impact::at_contact}>(
                               {.side = 20, .radius = 1, .steps = 1, .discs = discs})
                               .discs;
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
