#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "harness/scenes/hard_cases.hpp"
#include "harness/tests/collisions/exact_runs.hpp"
#include "harness/tests/scenes/random_scenes.hpp"

// The event-driven simulation proven right collision by collision: on every hard case, and on random scenes
// of every kind, also those whose discs overlap or lie outside at the start.

namespace carom {
namespace {

using tests::ExactRun;

void expect_proven(const Scene& scene, const std::string& name) {
    ExactRun run(scene);
    EXPECT_EQ(run.wrong(scene, 3), "") << name;
    EXPECT_EQ(run.checker.pair_collisions(), run.simulation.pair_collisions()) << name;
    EXPECT_EQ(run.checker.wall_collisions(), run.simulation.wall_collisions()) << name;
}

TEST(ExactRuns, AreProvenOnEveryHardCase) {
    for (const auto& [name, description, make] : hard_cases()) {
        if (name != "drift") { // in exact_runs_slow_test.cpp
            expect_proven(make(), std::string(name));
        }
    }
}

/// Some are wedged between walls, and others cross their box so often that they are followed for some time
/// alone.
TEST(ExactRuns, AreProvenOnRandomScenes) {
    const EventLimits limits{.at_once = 1000, .in_all = 5000};
    int ended = 0;
    const auto is_proven = [&](const std::string& wrong, std::uint64_t seed) {
        ended += wrong.empty();
        EXPECT_TRUE(wrong.empty() || wrong == ExactRun::given_up) << "scene " << seed << ": " << wrong;
    };
    const std::uint64_t scenes = tests::fuzz_scenes();
    for (std::uint64_t seed = 0; seed < scenes; ++seed) {
        const Scene scene = tests::awkward_scene(seed);
        ExactRun run(scene);
        is_proven(run.wrong(scene, 3, limits), seed);
    }
    EXPECT_GT(ended, static_cast<int>(scenes / 2));
}

} // namespace
} // namespace carom
