#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/energy_drift.hpp"
#include "harness/measure/measure.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/registry.hpp"

namespace carom {
namespace {

/// A simulation that does one of its steps wrong: it loses a tenth of one disc's speed.
class Leaky final : public Simulation {
  public:
    Leaky(std::unique_ptr<Simulation> right, int wrong_step)
        : right_(std::move(right)), wrong_step_(wrong_step) {}

    Tally step() override {
        const Tally tally = right_->step();
        discs_ = right_->discs();
        if (++steps_ == wrong_step_) {
            discs_[0].vx *= 0.9;
        }
        return tally;
    }
    void restart(const Scene& some_scene) override {
        right_->restart(some_scene);
        steps_ = 0;
    }
    std::vector<Disc> discs() const override { return steps_ == 0 ? right_->discs() : discs_; }

  private:
    std::unique_ptr<Simulation> right_;
    std::vector<Disc> discs_;
    int wrong_step_;
    int steps_ = 0;
};

const Scene scene{.side = 50, .radius = 1, .steps = 5, .discs = {{20, 20, 1, 0}, {30, 30, 0, -1}}};

Run run_leaky(int wrong_step, CheckScope scope, const Tuning& tuning = {}) {
    Leaky simulation(find_variant("published")->simulate(scene, tuning), wrong_step);
    return run_scene(scene, simulation, tuning, scope);
}

Run run_published(const Scene& some_scene, const Tuning& tuning = {}, const OnStep& on_step = nullptr) {
    const auto simulation = find_variant("published")->simulate(some_scene, tuning);
    return run_scene(some_scene, *simulation, tuning, CheckScope::nothing, on_step);
}

TEST(RunScene, NamesTheStepThatWentWrongAndStopsThere) {
    const auto run = run_leaky(3, CheckScope::every_step);
    EXPECT_EQ(
        run.violation,
        "step 3: disc 0 overlaps no other, yet its velocity changed from (1, 0) to (0.90000000000000002, 0)");
    EXPECT_EQ(run.discs[0].x, 23);
}

TEST(RunScene, LooksAtTheLastStepAloneOrNothingIfAskedTo) {
    EXPECT_EQ(run_leaky(5, CheckScope::nothing).violation, std::nullopt);
    EXPECT_NE(run_leaky(5, CheckScope::last_step).violation, std::nullopt);
    EXPECT_EQ(run_leaky(6, CheckScope::last_step).violation, std::nullopt);
}

TEST(RunScene, ChecksNoLastStepThatEndsInBitsWhichWereFoundRight) {
    std::set<std::string> right_ends;
    Check check(CheckScope::last_step);
    check.right_ends = &right_ends;
    const auto violation_of = [&check](int wrong_step) {
        Leaky simulation(find_variant("published")->simulate(scene, {}), wrong_step);
        return run_scene(scene, simulation, {}, check).violation;
    };
    EXPECT_NE(violation_of(5), std::nullopt);
    EXPECT_TRUE(right_ends.empty()) << "what is wrong is not kept";
    EXPECT_EQ(violation_of(6), std::nullopt);
    EXPECT_EQ(right_ends, (std::set{state_hash(run_published(scene).discs)}));
    EXPECT_NE(violation_of(5), std::nullopt) << "other bits are checked all the same";
    right_ends.insert(state_hash(run_leaky(5, CheckScope::nothing).discs));
    EXPECT_EQ(violation_of(5), std::nullopt) << "what is known is not checked";
}

/// A simulation without discs that notes how many steps it is asked for at once, and does not settle in one.
class Noting final : public Simulation {
  public:
    explicit Noting(std::int64_t unsettled) : unsettled_(unsettled) {}

    Tally step() override { return steps(1).work; }
    Steps steps(std::int64_t most) override {
        asked.push_back(most);
        const std::int64_t left = unsettled_ - done_;
        const std::int64_t count = std::min(most, left);
        done_ += count;
        return {.work = {.sweeps = count, .settled = most < left}, .count = count};
    }
    void restart(const Scene& /*some_scene*/) override { done_ = 0; }
    std::vector<Disc> discs() const override { return {}; }

    std::vector<std::int64_t> asked;

  private:
    std::int64_t unsettled_;
    std::int64_t done_ = 0;
};

TEST(RunScene, TakesThoseStepsAtOnceAtWhoseEndsNobodyLooks) {
    const Scene empty{.side = 50, .radius = 1, .steps = 5, .discs = {}};
    const auto asked = [&](const Check& check, const OnStep& on_step = nullptr) {
        Noting simulation(100);
        const carom::Run run = run_scene(empty, simulation, {.substeps = 4}, check, on_step);
        EXPECT_EQ(run.violation, std::nullopt);
        EXPECT_EQ(run.work.sweeps, 20);
        return simulation.asked;
    };
    using Asked = std::vector<std::int64_t>;
    EXPECT_EQ(asked(CheckScope::nothing), (Asked{1, 1, 1, 1, 16})) << "the first unit is timed by itself";
    EXPECT_EQ(asked(CheckScope::last_step), (Asked{1, 1, 1, 1, 12, 1, 1, 1, 1}));
    EXPECT_EQ(asked(CheckScope::every_step), Asked(20, 1));
    EXPECT_EQ(asked(CheckScope::nothing, [](int, const Simulation&) {}), Asked(20, 1));
}

TEST(RunScene, NamesTheSubstepThatDidNotSettleAmongThoseTakenAtOnce) {
    const Scene empty{.side = 50, .radius = 1, .steps = 5, .discs = {}};
    Noting simulation(14);
    const carom::Run run = run_scene(empty, simulation, {.substeps = 4}, CheckScope::nothing);
    ASSERT_NE(run.violation, std::nullopt);
    EXPECT_TRUE(run.violation->starts_with("step 4 substep 2 of 4: the resolve did not end"))
        << *run.violation;
    EXPECT_EQ(run.work.sweeps, 14);
}

TEST(RunScene, NamesTheSubstepThatWentWrong) {
    const auto run = run_leaky(6, CheckScope::every_step, {.substeps = 4});
    ASSERT_NE(run.violation, std::nullopt);
    EXPECT_TRUE(run.violation->starts_with("step 2 substep 2 of 4: disc 0")) << *run.violation;
}

TEST(RunScene, ShowsTheStateOfEveryUnitOfTime) {
    for (const int substeps : {1, 4}) {
        std::vector<int> steps;
        std::vector<double> positions;
        run_published(scene, {.substeps = substeps}, [&](int step, const Simulation& simulation) {
            const std::vector<Disc> discs = simulation.discs();
            steps.push_back(step);
            positions.push_back(discs[0].x);
        });
        EXPECT_EQ(steps, (std::vector<int>{1, 2, 3, 4, 5}));
        EXPECT_EQ(positions, (std::vector<double>{21, 22, 23, 24, 25}));
    }
}

TEST(RunScene, AddsUpTheWorkAndEndsInTheStateOfTheKernel) {
    const Scene busy = tests::random_scene(200, 60, 1, 10, 3, 131);
    const auto run = run_published(busy);
    const tests::Outcome expected = tests::simulate<Policies{}>(busy);
    EXPECT_TRUE(tests::same_bits(run.discs, expected.discs));
    EXPECT_EQ(run.work, expected.work);
    EXPECT_GT(run.steps_seconds, 0);
}

TEST(EnergyDrift, IsRelativeToTheStart) {
    EXPECT_DOUBLE_EQ(energy_drift(scene, {{0, 0, 2, 0}}).value(), 1);
    EXPECT_DOUBLE_EQ(energy_drift(scene, {{0, 0, 1, 0}}).value(), -0.5);
    EXPECT_EQ(energy_drift({.side = 9, .radius = 1, .steps = 0, .discs = {{1, 1, 0, 0}}}, {{1, 1, 0, 0}}),
              std::nullopt);
}

TEST(DiscsOutside, AreThoseWithCentresBeyondAWall) {
    EXPECT_EQ(discs_outside(scene, {{0, 0, 0, 0}, {50, 50, 0, 0}, {25, 25, 0, 0}}), 0);
    EXPECT_EQ(discs_outside(scene, {{-0.1, 5, 0, 0}, {5, -0.1, 0, 0}, {50.1, 5, 0, 0}, {5, 50.1, 0, 0}}), 4);
    EXPECT_EQ(discs_outside(scene, {{std::nan(""), 5, 0, 0}}), 1);
}

TEST(StateHash, IsFnv1aOverTheBytesOfTheState) {
    // Worked out byte by byte by another program from the definition of FNV-1a with 64 bits.
    EXPECT_EQ(state_hash({}), "cbf29ce484222325");
    EXPECT_EQ(state_hash({{0, 0, 0, 0}}), "0c8210784d8af5a5");
    EXPECT_EQ(state_hash({{1, 2, 3, 4}}), "93b2be02cd2882a0");
    EXPECT_NE(state_hash({{0, 0, 0, 0}}), state_hash({{0, 0, 0, -0.0}}));
}

} // namespace
} // namespace carom
