#include <csignal>
#include <cstdlib>
#include <ostream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "kernels/tests/all_pairs.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {

static void PrintTo(Order order, std::ostream* stream) {
    *stream << (order == Order::once ? "once" : "repeat");
}

namespace {

/// A disc that touches two opposite walls at once, and moves.
Scene wedged() { return {.side = 2, .radius = 1, .steps = 1, .discs = {{0.5, 1, 0.5, 0}}}; }

/// Two discs that touch each other and a wall each: what one wall turns away comes back from the other.
Scene jammed() { return {.side = 4, .radius = 1, .steps = 1, .discs = {{1, 2, 0, 0}, {2, 2, 1, 0}}}; }

template <Order order> void gives_up_at_the_sweep_limit(const Scene& scene) {
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

TEST(SweepLimit, EndsEveryOrderOnADiscWedgedBetweenWalls) {
    gives_up_at_the_sweep_limit<Order::checkered>(wedged());
    gives_up_at_the_sweep_limit<Order::row>(wedged());
    gives_up_at_the_sweep_limit<Order::track>(wedged());
    gives_up_at_the_sweep_limit<Order::repeat>(wedged());
    gives_up_at_the_sweep_limit<Order::once>(wedged());
    gives_up_at_the_sweep_limit<Order::strips>(wedged());
    gives_up_at_the_sweep_limit<Order::wavefront>(wedged());
}

TEST(SweepLimit, EndsEveryOrderOnDiscsJammedBetweenWalls) {
    gives_up_at_the_sweep_limit<Order::checkered>(jammed());
    gives_up_at_the_sweep_limit<Order::row>(jammed());
    gives_up_at_the_sweep_limit<Order::track>(jammed());
    gives_up_at_the_sweep_limit<Order::repeat>(jammed());
    gives_up_at_the_sweep_limit<Order::once>(jammed());
    gives_up_at_the_sweep_limit<Order::strips>(jammed());
    gives_up_at_the_sweep_limit<Order::wavefront>(jammed());
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

TEST(SweepLimit, LeavesAWedgedDiscAtRestAlone) {
    Scene scene = wedged();
    scene.discs[0] = {1, 1, 0, 0};
    EXPECT_TRUE(tests::simulate<Policies{}>(scene, {.sweep_limit = 1}).work.settled);
}

/// Runs the reference in a process of its own, which ends with 0 only if the reference gave up in time.
[[noreturn]] void run_the_reference(const Scene& scene, Order order) {
    alarm(10);
    const auto outcome = tests::simulate_all_pairs(scene, {.order = order}, {.sweep_limit = 7});
    std::exit(outcome.work.settled ? 1 : 0);
}

class ReferenceSweepLimit : public testing::TestWithParam<Order> {
  protected:
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_P(ReferenceSweepLimit, EndsOnAWedgedDisc) {
    EXPECT_EXIT(run_the_reference(wedged(), GetParam()), testing::ExitedWithCode(0), "");
}

TEST_P(ReferenceSweepLimit, EndsOnJammedDiscs) {
    EXPECT_EXIT(run_the_reference(jammed(), GetParam()), testing::ExitedWithCode(0), "");
}

INSTANTIATE_TEST_SUITE_P(OnceAndRepeat, ReferenceSweepLimit, testing::Values(Order::once, Order::repeat),
                         testing::PrintToStringParamName());

} // namespace
} // namespace carom
