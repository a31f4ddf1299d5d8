#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/move.hpp"
#include "kernels/step.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::same_bits;

TEST(Move, AddsVelocityTimesTheStep) {
    for (const int substeps : {1, 2, 3, 10}) {
        for (const int threads : {1, 3}) {
            SCOPED_TRACE(testing::Message() << substeps << " substeps, " << threads << " threads");
            const Scene scene = tests::random_scene(2500, 60, 1, 1, 3, 51);
            State<> state(scene);
            NoProbe probe;
            move(state, {.threads = threads, .substeps = substeps}, probe);
            for (std::size_t i = 0; i < scene.discs.size(); ++i) {
                const Disc& before = scene.discs[i];
                const double dt = 1.0 / substeps;
                const Disc expected{before.x + before.vx * dt, before.y + before.vy * dt, before.vx,
                                    before.vy};
                ASSERT_TRUE(same_bits(state.discs[i], expected)) << i;
            }
        }
    }
}

TEST(Bin, PutsEveryDiscIntoTheBoxOfItsCentreInTheOrderOfNumbers) {
    State<> state(tests::random_scene(500, 60, 1, 1, 3, 52));
    NoProbe probe;
    for (int step = 0; step < 2; ++step) {
        move(state, {}, probe);
        bin(state, {}, probe);
        std::size_t binned = 0;
        for (int row = 0; row < state.grid.boxes_per_side(); ++row) {
            for (int column = 0; column < state.grid.boxes_per_side(); ++column) {
                const std::vector<int>& discs = state.discs_in(row, column);
                binned += discs.size();
                for (std::size_t k = 0; k < discs.size(); ++k) {
                    const Disc& disc = state.discs[static_cast<std::size_t>(discs[k])];
                    EXPECT_EQ(state.grid.coordinate(disc.x), column);
                    EXPECT_EQ(state.grid.coordinate(disc.y), row);
                    EXPECT_TRUE(k == 0 || discs[k - 1] < discs[k]);
                }
            }
        }
        EXPECT_EQ(binned, state.discs.size());
    }
}

TEST(Step, CountsWhatItDid) {
    // One pair meets head-on in the middle, one disc turns at a wall, one pair overlaps without approaching.
    State<Policies{.self_contained = SelfContained::off}> state(
        {.side = 50,
         .radius = 1,
         .steps = 1,
         .discs = {
             {23.5, 27, 0.25, 0}, {25.5, 27, -0.25, 0}, {1.5, 12, -1, 0}, {37, 37, 0, 0}, {38, 37, 0, 0}}});
    NoProbe probe;
    const Tally tally = step(state, {}, probe);
    EXPECT_EQ(
        tally,
        (Tally{.overlaps = 2, .pair_resolves = 1, .pair_attempts = 9, .wall_resolves = 1, .sweeps = 2}));
}

TEST(Step, OfAFractionOfTimeMovesThatFar) {
    State<> state({.side = 50, .radius = 1, .steps = 1, .discs = {{10, 10, 1, -2}}});
    NoProbe probe;
    for (int substep = 0; substep < 4; ++substep) {
        step(state, {.substeps = 4}, probe);
    }
    EXPECT_EQ(state.discs[0], (Disc{11, 8, 1, -2}));
}

/// The order in which the step announces what it does.
class Announcements final : public Probe {
  public:
    void phase_begin(Phase phase) override { said.push_back("begin " + name(phase)); }
    void phase_end(Phase phase) override { said.push_back("end " + name(phase)); }
    void sweep_begin() override { said.emplace_back("begin sweep"); }
    void sweep_end() override { said.emplace_back("end sweep"); }
    void loop_begin(int) override { ++loops; }
    void wait_begin(int) override {}
    void wait_end(int) override {}
    void iteration(int, int) override { ++iterations; }
    void loop_end(int) override {}
    void barrier_end(int) override {}

    std::vector<std::string> said;
    int loops = 0;
    int iterations = 0;

  private:
    static std::string name(Phase phase) {
        const std::vector<std::string> names{"move", "bin", "find", "resolve"};
        return names[static_cast<std::size_t>(phase)];
    }
};

TEST(Step, TellsTheProbeItsPhasesAndSweeps) {
    State<> state({.side = 50, .radius = 1, .steps = 1, .discs = {{10, 10, 1, 0}}});
    Announcements probe;
    const Tally tally = step(state, {}, probe);
    EXPECT_EQ(tally.sweeps, 1);
    EXPECT_EQ(probe.said, (std::vector<std::string>{"begin move", "end move", "begin bin", "end bin",
                                                    "begin find", "end find", "begin resolve", "begin sweep",
                                                    "end sweep", "end resolve"}));
    EXPECT_EQ(probe.loops, 1 + 4) << "one to find, one for each colour";
    EXPECT_EQ(probe.iterations, 100 + 100) << "every box in find, every box in the sweep";
}

TEST(Step, EndsInTheSameBitsUnderObservation) {
    const Scene scene = tests::random_scene(200, 60, 1, 10, 3, 53);
    State<> state(scene);
    Announcements probe;
    for (int k = 0; k < scene.steps; ++k) {
        step(state, {}, static_cast<Probe&>(probe));
    }
    EXPECT_TRUE(same_bits(state.discs, tests::simulate<Policies{}>(scene).discs));
}

} // namespace
} // namespace carom
