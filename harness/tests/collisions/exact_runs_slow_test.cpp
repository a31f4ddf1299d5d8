#include <gtest/gtest.h>

#include "harness/measure/measure.hpp"
#include "harness/scenes/hard_cases.hpp"
#include "harness/tests/collisions/exact_runs.hpp"
#include "harness/tests/scenes/gas.hpp"

namespace carom {
namespace {

TEST(ExactRunsSlow, AreProvenAmongAHundredThousandDiscs) {
    for (const double area_fraction : {0.02, 0.1, 0.4, 0.65, 0.8}) {
        const int count = 100'000;
        const Scene scene = tests::gas(count, tests::side_of(count, area_fraction), 4, 0.1, 0.5, 22);
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
