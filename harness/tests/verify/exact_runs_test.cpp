#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "harness/scenes/generate.hpp"
#include "harness/scenes/hard_cases.hpp"
#include "harness/tests/scenes/random_scenes.hpp"
#include "harness/tests/verify/exact_runs.hpp"
#include "kernels/tests/simulate.hpp"

// The event-driven simulation, in both precisions, proven right collision by collision: on every hard case,
// and on random scenes of every kind, also those whose discs overlap or lie outside at the start.

namespace carom {
namespace {

using tests::ExactRun;

/// Only where discs are wedged between walls, or overlap as they please, does an instant never end.
void is_proven(const Scene& scene, const std::string& name, bool may_be_wedged) {
    ExactRun<double> run(scene);
    const std::string wrong = run.wrong(scene, 3);
    EXPECT_TRUE(wrong.empty() || (may_be_wedged && wrong == "wedged")) << name << ": " << wrong;
    ExactRun<long double> extended(scene);
    const std::string wrong_extended = extended.wrong(scene, 1);
    EXPECT_TRUE(wrong_extended.empty() || (may_be_wedged && wrong_extended == "wedged"))
        << name << ", in long double: " << wrong_extended;
    EXPECT_EQ(run.checker.pair_collisions(), run.simulation.pair_collisions()) << name;
    EXPECT_EQ(run.checker.wall_collisions(), run.simulation.wall_collisions()) << name;
}

TEST(ExactRuns, AreProvenOnEveryHardCase) {
    for (const auto& [name, description, make] : hard_cases()) {
        if (name != "drift") { // in exact_runs_slow_test.cpp
            is_proven(make(), std::string(name), false);
        }
    }
}

TEST(ExactRuns, AreProvenOnRandomScenes) {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        is_proven(tests::awkward_scene(seed), "scene " + std::to_string(seed), true);
    }
}

TEST(ExactRuns, EndInTheSameBitsWhetherTheyAreToldOrNot) {
    const Scene scene = generate({.count = 300,
                                  .side = 40,
                                  .radius = 1,
                                  .steps = 20,
                                  .least_velocity = 0.1,
                                  .largest_velocity = 1,
                                  .seed = 21,
                                  .placement = Placement::lattice,
                                  .isotropic = true});
    ExactRun<double> told(scene);
    ASSERT_EQ(told.wrong(scene, 20), "");
    EventDriven<double> untold(scene);
    ASSERT_TRUE(untold.advance(20));
    EXPECT_TRUE(tests::same_bits(told.simulation.discs(), untold.discs()));
    EXPECT_GT(told.checker.pair_collisions(), 1000);
}

} // namespace
} // namespace carom
