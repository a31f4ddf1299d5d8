#include <cstddef>

#include <gtest/gtest.h>

#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {

namespace {

/// Two discs that touch each other and a wall each: what one wall turns away comes back from the other.
Scene jammed() { return {.side = 4, .radius = 1, .steps = 1, .discs = {{1, 2, 0, 0}, {2, 2, 1, 0}}}; }

template <Order order> void gives_up_at_the_sweep_limit() {
    const Scene scene = jammed();
    for (const int limit : {1, 7, 250}) {
        SCOPED_TRACE(limit);
        const auto outcome =
            tests::simulate<Policies{.order = order}>(scene, {.threads = 2, .sweep_limit = limit});
        EXPECT_FALSE(outcome.work.settled);
        EXPECT_EQ(outcome.work.sweeps, limit);
        double energy_before = 0;
        double energy_after = 0;
        for (std::size_t i = 0; i < scene.discs.size(); ++i) {
            energy_before += scene.discs[i].vx * scene.discs[i].vx;
            energy_after += outcome.discs[i].vx * outcome.discs[i].vx;
        }
        EXPECT_EQ(energy_after, energy_before);
    }
}

TEST(SweepLimit, EndsEveryOrderOnDiscsJammedBetweenWalls) {
    gives_up_at_the_sweep_limit<Order::checkered>();
    gives_up_at_the_sweep_limit<Order::row>();
    gives_up_at_the_sweep_limit<Order::track>();
    gives_up_at_the_sweep_limit<Order::repeat>();
    gives_up_at_the_sweep_limit<Order::once>();
    gives_up_at_the_sweep_limit<Order::strips>();
    gives_up_at_the_sweep_limit<Order::wavefront>();
}

TEST(SweepLimit, IsNoErrorWhereTheLastSweepSettles) {
    const Scene scene = tests::cradle();
    const auto unlimited = tests::simulate<Policies{.order = Order::once}>(scene);
    ASSERT_TRUE(unlimited.work.settled);
    const auto settles_with = [&scene](int limit) {
        return tests::simulate<Policies{.order = Order::once}>(scene, {.sweep_limit = limit}).work.settled;
    };
    EXPECT_FALSE(settles_with(1));
    EXPECT_TRUE(settles_with(100));
}

} // namespace
} // namespace carom
