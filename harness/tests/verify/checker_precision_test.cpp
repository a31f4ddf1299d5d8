#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/verify/checker.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

const Rounding in_float(std::numeric_limits<float>::epsilon());

struct FloatDisc {
    float x;
    float y;
    float vx;
    float vy;
};

/// A slow and obvious simulation in float: every disc against every other one until nothing changes.
class FloatSimulation {
  public:
    explicit FloatSimulation(const Scene& scene)
        : side_(static_cast<float>(scene.side)), radius_(static_cast<float>(scene.radius)) {
        for (const Disc& disc : scene.discs) {
            discs_.push_back({static_cast<float>(disc.x), static_cast<float>(disc.y),
                              static_cast<float>(disc.vx), static_cast<float>(disc.vy)});
        }
    }

    std::vector<Disc> discs() const {
        std::vector<Disc> widened;
        for (const FloatDisc& disc : discs_) {
            widened.push_back({disc.x, disc.y, disc.vx, disc.vy});
        }
        return widened;
    }

    void step(float dt) {
        for (FloatDisc& disc : discs_) {
            disc.x += disc.vx * dt;
            disc.y += disc.vy * dt;
        }
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t i = 0; i < discs_.size(); ++i) {
                changed = turn(discs_[i].x, discs_[i].vx) || changed;
                changed = turn(discs_[i].y, discs_[i].vy) || changed;
                for (std::size_t j = 0; j < i; ++j) {
                    changed = collide(discs_[i], discs_[j]) || changed;
                }
            }
        }
    }

  private:
    bool turn(float position, float& velocity) const {
        if ((position - radius_ <= 0 && velocity < 0) || (position + radius_ >= side_ && velocity > 0)) {
            velocity = -velocity;
            return true;
        }
        return false;
    }

    bool collide(FloatDisc& one, FloatDisc& two) const {
        const float dx = two.x - one.x;
        const float dy = two.y - one.y;
        const float square = dx * dx + dy * dy;
        const float approach = (two.vx - one.vx) * dx + (two.vy - one.vy) * dy;
        const float speeds = one.vx * one.vx + one.vy * one.vy + two.vx * two.vx + two.vy * two.vy;
        if (square > 4 * radius_ * radius_ || square == 0 ||
            approach >= -64 * std::numeric_limits<float>::epsilon() * std::sqrt(square * speeds)) {
            return false;
        }
        const float impulse = approach / square;
        one.vx += impulse * dx;
        one.vy += impulse * dy;
        two.vx -= impulse * dx;
        two.vy -= impulse * dy;
        return true;
    }

    float side_;
    float radius_;
    std::vector<FloatDisc> discs_;
};

/// The first violation in all steps, each of dt = 1 / substeps.
std::string first_violation(const Scene& scene, int substeps, const Rounding& rounding) {
    const Checker checker(scene.side, scene.radius, 1.0 / substeps, Tolerance::relative, rounding);
    FloatSimulation simulation(scene);
    for (int step = 0; step < scene.steps * substeps; ++step) {
        const std::vector<Disc> before = simulation.discs();
        simulation.step(1 / static_cast<float>(substeps));
        if (const auto violation = checker.step(before, simulation.discs())) {
            return *violation;
        }
    }
    return "";
}

TEST(CheckerInFloat, PassesRightSteps) {
    for (const int substeps : {1, 3, 10}) {
        EXPECT_EQ(first_violation(tests::random_scene(200, 60, 1, 12, 3, 1), substeps, in_float), "");
        EXPECT_EQ(first_violation(tests::random_scene_of_density(300, 0.9, 10, 4), substeps, in_float), "");
        EXPECT_EQ(first_violation(tests::random_scene(100, 61.7, 1.1, 12, 0.1, 2), substeps, in_float), "");
        EXPECT_EQ(first_violation(tests::cradle(), substeps, in_float), "");
        EXPECT_EQ(first_violation(tests::coincident(), substeps, in_float), "");
    }
}

/// In double the disc stands a little off the wall that it touches in float.
TEST(CheckerInFloat, RoundsTheBoxAsTheVariantDoes) {
    const Scene scene{.side = 1558.9630366183724,
                      .radius = 15.187010857032297,
                      .steps = 1,
                      .discs = {{1543.7760257613402, 216.35663577983073, 0x1p-30, 0x1p-30},
                                {1543.7760257613402, 216.35377285612796, 0, 0}}};
    EXPECT_EQ(first_violation(scene, 1, in_float), "");
    EXPECT_NE(first_violation(scene, 1, Rounding()), "");
}

TEST(CheckerInFloat, IsNeededForFloat) {
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "moved from",
                        first_violation(tests::random_scene(200, 60, 1, 12, 3, 1), 1, Rounding()));
}

/// The state after a right step of two discs that collide, one at a wall and one alone, then made wrong.
std::string violation_after(const std::function<void(std::vector<Disc>&)>& mutate) {
    const Scene scene{.side = 50,
                      .radius = 1,
                      .steps = 1,
                      .discs = {{20, 20, 0.5, 0.25}, {22, 21, -0.5, 0}, {1.5, 10, -1, 0.5}, {35, 35, 1, -1}}};
    FloatSimulation simulation(scene);
    const std::vector<Disc> before = simulation.discs();
    simulation.step(1);
    std::vector<Disc> after = simulation.discs();
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
