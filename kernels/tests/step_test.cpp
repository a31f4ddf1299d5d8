#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/step.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

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

/// The order in which the step announces what it does.
class Announcements final : public Probe {
  public:
    void phase_begin(Phase phase) override { said.push_back("begin " + name(phase)); }
    void phase_end(Phase phase) override { said.push_back("end " + name(phase)); }
    void sweep_begin() override { said.emplace_back("begin sweep"); }
    void sweep_end() override { said.emplace_back("end sweep"); }
    void loop_begin(int) override { ++loops; }
    void iteration(int, int) override { ++iterations; }

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

} // namespace
} // namespace carom
