#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harness/verify/checker.hpp"
#include "kernels/step.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

const Rounding in_float(std::numeric_limits<float>::epsilon());

/// The state before and after a step in float.
std::pair<std::vector<Disc>, std::vector<Disc>> stepped(const Scene& scene) {
    State<Policies{.precision = Precision::float_}> state(scene);
    NoProbe probe;
    const std::vector<Disc> before = discs_by_number(state);
    step(state, {}, probe);
    return {before, discs_by_number(state)};
}

std::string violation_of(const Scene& scene, const Rounding& rounding) {
    const auto [before, after] = stepped(scene);
    return Checker(scene.side, scene.radius, 1, Tolerance::relative, rounding)
        .step(before, after)
        .value_or("");
}

/// In double the disc stands a little off the wall that it touches in float.
TEST(CheckerInFloat, RoundsTheBoxAsTheVariantDoes) {
    const Scene scene{.side = 1558.9630366183724,
                      .radius = 15.187010857032297,
                      .steps = 1,
                      .discs = {{1543.7760257613402, 216.35663577983073, 0x1p-30, 0x1p-30},
                                {1543.7760257613402, 216.35377285612796, 0, 0}}};
    EXPECT_EQ(violation_of(scene, in_float), "");
    EXPECT_NE(violation_of(scene, Rounding()), "");
}

TEST(CheckerInFloat, IsNeededForFloat) {
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "moved from",
                        violation_of(tests::random_scene(200, 60, 1, 12, 3, 1), Rounding()));
}

/// The state after a right step of two discs that collide, one at a wall and one alone, then made wrong.
std::string violation_after(const std::function<void(std::vector<Disc>&)>& mutate) {
    const Scene scene{.side = 50,
                      .radius = 1,
                      .steps = 1,
                      .discs = {{20, 20, 0.5, 0.25}, {22, 21, -0.5, 0}, {1.5, 10, -1, 0.5}, {35, 35, 1, -1}}};
    auto [before, after] = stepped(scene);
    mutate(after);
    return Checker(scene.side, scene.radius, 1, Tolerance::relative, in_float)
        .step(before, after)
        .value_or("");
}

TEST(CheckerInFloat, CatchesWhatIsWrongByMoreThanRounding) {
    EXPECT_EQ(violation_after([](auto&) {}), "");
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "disc 3 moved from", violation_after([](auto& discs) {
                            discs[3].x =
                                static_cast<double>(std::nextafter(static_cast<float>(discs[3].x), 100.0f));
                        }));
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "changed its energy",
                        violation_after([](auto& discs) { discs[1].vx *= 1.001; }));
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "changed its momentum",
                        violation_after([](auto& discs) { std::swap(discs[0].vx, discs[0].vy); }));
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "disc 3 overlaps no other",
                        violation_after([](auto& discs) { discs[3].vx *= 1 + 0x1p-23; }));
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "moving into a wall",
                        violation_after([](auto& discs) { discs[2].vx = -1; }));
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "left approaching", violation_after([](auto& discs) {
                            std::swap(discs[0].vx, discs[1].vx);
                            std::swap(discs[0].vy, discs[1].vy);
                        }));
}

} // namespace
} // namespace carom
