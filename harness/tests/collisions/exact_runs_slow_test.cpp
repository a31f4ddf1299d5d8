#include <cmath>

#include <gtest/gtest.h>

#include "harness/measure/measure.hpp"
#include "harness/scenes/generate.hpp"
#include "harness/scenes/hard_cases.hpp"
#include "harness/tests/collisions/exact_runs.hpp"

namespace carom {
namespace {

TEST(ExactRunsSlow, AreProvenAmongAHundredThousandDiscs) {
    for (const double area_fraction : {0.02, 0.1, 0.4, 0.65, 0.8}) {
        const int count = 100'000;
        const Scene scene =
            generate({.count = count,
                      .side = std::sqrt(count * 3.141592653589793 / area_fraction),
                      .radius = 1,
                      .steps = 4,
                      .least_velocity = 0.1,
                      .largest_velocity = 0.5,
                      .seed = 22,
                      .placement = area_fraction > 0.3 ? Placement::lattice : Placement::random,
                      .isotropic = true});
        const carom::Run run = checked_run(scene, event_driven(), {});
        EXPECT_EQ(run.violation, std::nullopt) << area_fraction;
        EXPECT_GT(run.work.pair_resolves, 1000) << area_fraction;
    }
}

TEST(ExactRunsSlow, AreProvenOverAMillionCollisions) {
    const Scene scene = find_hard_case("drift")->scene();
    tests::ExactRun run(scene);
    EXPECT_EQ(run.wrong(scene, 100), "");
    EXPECT_GT(run.checker.pair_collisions(), 1'000'000);
}

} // namespace
} // namespace carom
