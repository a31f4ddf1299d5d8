#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/scenes/changed_scenes.hpp"
#include "harness/tests/verify/hard_cases.hpp"
#include "variants/tests/each_variant.hpp"

namespace carom {
namespace {

using tests::checked_run;
using tests::scene_of;

class InTime : public testing::TestWithParam<Variant> {
  protected:
    /// The last of so many steps at which nothing collides.
    static int last_quiet_step(const Scene& scene, const Tuning& tuning) {
        const auto simulation = GetParam().simulate(scene, tuning);
        int last = 0;
        for (int step = 1; step <= scene.steps * tuning.substeps; ++step) {
            if (!simulation->step().changed()) {
                last = step;
            }
        }
        return last;
    }

    static std::vector<Disc> after(int steps, const Scene& scene, const Tuning& tuning) {
        const auto simulation = GetParam().simulate(scene, tuning);
        for (int step = 0; step < steps; ++step) {
            simulation->step();
        }
        return simulation->discs();
    }

    /// How far, at most, a disc ends from its start, if all take so many steps, are turned, and take as many.
    static double missed_after(int steps, const Scene& scene, const Tuning& tuning) {
        Scene back = scene;
        back.discs = after(steps, scene, tuning);
        return tests::largest_distance(after(steps, turned_back(back), tuning), scene.discs);
    }
};

/// Of two discs of relative speed v in a box of area A, the reference brings 4 r v / A together per unit of
/// time; a step of dt finds them overlapping and approaching with probability 2 pi r^2 / A. The share seen is
/// pi r / (2 v dt): less than one in a thousand at 20 box lengths of 60 r a step, and fewer still since most
/// discs are outside the box at most times.
TEST_P(InTime, TunnellingLosesNearlyAllCollisions) {
    const Scene scene = scene_of("fast");
    const carom::Run done = checked_run(GetParam(), scene);
    EventDriven<double> reference(scene);
    ASSERT_TRUE(reference.advance(scene.steps));
    const auto collisions = static_cast<double>(reference.pair_collisions());
    const double slowest = 20 * scene.side;
    const auto seen = static_cast<double>(done.work.pair_resolves);
    EXPECT_GT(collisions, 10'000);
    EXPECT_LT(seen / collisions, 4 * std::numbers::pi * scene.radius / (2 * slowest));
    RecordProperty("collisions of the reference", std::to_string(reference.pair_collisions()));
    RecordProperty("collisions seen", std::to_string(done.work.pair_resolves));
}

/// Let a pair be apart by d - v dt before a step and by d after it, overlapping and approaching. The
/// collision turns the relative velocity v to v' with d.v' = -d.v, so that |d + v' dt| = |d - v dt|: a step
/// later it is apart again. Coming back, it is found overlapping at d, and nowhere else, and gets -v. So is a
/// disc at a wall. Where discs meet one at a time, steps are therefore reversible but for rounding, which
/// each collision multiplies by some 20 (the free path over the radius). Two things must not be: a state
/// turned back in the step of a collision, and a pair first found when it is parting already, which is let
/// pass and, coming back, is not. In steps of 1/4 and 1/64 of this scene there is no such pair, in steps of 1
/// there is. At contact paths are followed as they are, and lead back in steps of any length.
TEST_P(InTime, FindsItsWayBackWhereDiscsMeetOneAtATime) {
    const double allowed = 64 * 20 * 20 * 20 * rounding_of(GetParam().policies).epsilon();
    const Scene scene = plain_scene();
    for (const Tuning& tuning : {Tuning{.substeps = 4}, Tuning{.substeps = 64}}) {
        const int steps = last_quiet_step(scene, tuning);
        ASSERT_GT(steps, 30 * tuning.substeps);
        EXPECT_LT(missed_after(steps, scene, tuning), allowed) << tuning.substeps << " substeps";
    }
    const double missed = missed_after(last_quiet_step(scene, {}), scene, {});
    if (GetParam().policies.impact == Impact::at_contact) {
        EXPECT_LT(missed, allowed);
    } else {
        EXPECT_GT(missed, 0.1);
    }
}

/// Several contacts of one disc are resolved one after the other: back, they would have to be in the opposite
/// order.
TEST_P(InTime, LosesItsWayBackWhereDiscsMeetSeveralAtATime) {
    const Scene scene = scene_of("hexagonal");
    const double missed = missed_after(scene.steps, scene, {});
    EXPECT_GT(missed, 0.1);
    RecordProperty("missed", std::to_string(missed));
}

INSTANTIATE_TEST_SUITE_P(Registry, InTime, testing::ValuesIn(variants().begin(), variants().end()),
                         tests::variant_test_name);

TEST(ReversedCase, LeadsTheReferenceBackToTheStartOfThePlainScene) {
    const Scene scene = scene_of("reversed");
    EventDriven<double> reference(scene);
    ASSERT_TRUE(reference.advance(scene.steps));
    EXPECT_GT(reference.pair_collisions(), 20);
    const Scene plain = plain_scene();
    EXPECT_LT(tests::largest_distance(reference.discs(), plain.discs), 1e-9);
}

} // namespace
} // namespace carom
