#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/energy_drift.hpp"
#include "harness/support/format.hpp"
#include "harness/tests/verify/hard_cases.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/tests/each_variant.hpp"

namespace carom {
namespace {

using tests::checked_run;
using tests::scene_of;

class SlowHardCases : public testing::TestWithParam<Variant> {};

/// A collision errs by a few roundings of the pair's energy, one hundredth of the scene's, in either
/// direction: over n of them by their root, some 1e-2 * sqrt(n) * 4 epsilon; and by no more than n times that
/// if all went the same way.
TEST_P(SlowHardCases, DriftStaysWithinWhatRoundingAllows) {
    const Scene scene = scene_of("drift");
    const auto simulation = GetParam().simulate(scene, {});
    const Rounding rounding = rounding_of(GetParam().policies);
    const carom::Run run = run_scene(scene, *simulation, {}, {CheckScope::last_step, GetParam()});
    EXPECT_EQ(run.violation, std::nullopt);
    const auto collisions = static_cast<double>(run.work.pair_resolves);
    EXPECT_GT(collisions, 500'000);
    const double drift = energy_drift(scene, run.discs).value();
    EXPECT_LT(std::abs(drift), 4 * rounding.epsilon() * std::sqrt(collisions));
    RecordProperty("energy drift", format("%.2e", drift));
}

/// A double at 9e7 is known to 1.5e-8: the two discs exchange their velocities, to a rounding of the normal,
/// which lies along x. A float there is a multiple of 8 r: nothing moves at all. At contact they meet when
/// they are 2 r apart, after 10/7 of 5 units of time, and the third is turned after 5/2 and 10/3.
TEST_P(SlowHardCases, FarCoordinatesCostTheirLastDigits) {
    const Scene scene = scene_of("far_coordinates");
    const carom::Run run = checked_run(GetParam(), scene);
    if (!rounding_of(GetParam().policies).is_double()) {
        EXPECT_EQ(tests::largest_distance(run.discs, tests::start_of(GetParam(), scene)), 0);
        return;
    }
    EXPECT_NEAR(run.discs[0].vx, -0.7, 1e-15);
    EXPECT_NEAR(run.discs[1].vx, 0.7, 1e-15);
    const bool at_contact = GetParam().policies.impact == Impact::at_contact;
    EXPECT_NEAR(run.discs[1].x - run.discs[0].x, at_contact ? 2 + 5 * 1.4 - 2 : 1.2 + 3 * 1.4, 1e-7);
    EXPECT_EQ(run.discs[2], at_contact ? (Disc{1e8 - 3.5, 1e8 - 2.25, -1, -0.75})
                                       : (Disc{1e8 - 2.5, 1e8 - 1.25, -1, -0.75}));
}

INSTANTIATE_TEST_SUITE_P(Registry, SlowHardCases, testing::ValuesIn(variants().begin(), variants().end()),
                         tests::variant_test_name);

} // namespace
} // namespace carom
