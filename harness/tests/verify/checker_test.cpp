#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/verify/checker.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

constexpr double side = 50;
constexpr double radius = 1;

/// What the discs of `before` are there for.
enum Role : std::size_t { pair_first, pair_second, lone, at_wall, receding_first, receding_second };

const std::vector<Disc> before{{20, 20, 0.5, 0.25}, {22, 21, -0.5, 0}, {35, 35, 1, -1},
                               {1.5, 10, -1, 0.5},  {30, 8, -0.25, 0}, {31, 8, 0.5, 0.125}};

std::vector<Disc> rightly_stepped() {
    return tests::simulate<Policies{}>({.side = side, .radius = radius, .steps = 1, .discs = before}).discs;
}

std::string violation(const std::vector<Disc>& start, const std::vector<Disc>& end) {
    return Checker(side, radius, 1, Tolerance::relative).step(start, end).value_or("");
}

void turn(Disc& disc, double angle) {
    const double vx = disc.vx;
    disc.vx = std::cos(angle) * vx - std::sin(angle) * disc.vy;
    disc.vy = std::sin(angle) * vx + std::cos(angle) * disc.vy;
}

void turn_pair(std::vector<Disc>& discs, double angle) {
    turn(discs[pair_first], angle);
    turn(discs[pair_second], angle);
}

void speed_up(Disc& disc, double factor) {
    disc.vx *= factor;
    disc.vy *= factor;
}

struct Mutant {
    std::string name;
    std::function<void(std::vector<Disc>&)> mutate;
    std::string message;
};

const std::vector<Mutant> mutants{
    {"UnmovedDisc",
     [](auto& discs) {
         discs[lone].x = 35;
         discs[lone].y = 35;
     },
     "disc 2 moved from (35, 35) to (35, 35) instead of to (36, 34)"},
    {"DiscMovedByOneUlpTooMuch", [](auto& discs) { discs[lone].y = std::nextafter(34.0, 35.0); },
     "disc 2 moved from (35, 35) to (36, 34.000000000000007) instead of to (36, 34)"},
    {"ExchangedDiscs", [](auto& discs) { std::swap(discs[lone], discs[at_wall]); },
     "disc 2 moved from (35, 35)"},
    {"LostDisc", [](auto& discs) { discs.pop_back(); }, "6 discs became 5"},
    {"UnresolvedPair",
     [](auto& discs) {
         discs[pair_first].vx = before[pair_first].vx;
         discs[pair_first].vy = before[pair_first].vy;
         discs[pair_second].vx = before[pair_second].vx;
         discs[pair_second].vy = before[pair_second].vy;
     },
     "discs 0 and 1, 1.25 apart, are left approaching at "},
    {"UnresolvedWall", [](auto& discs) { discs[at_wall].vx = -1; },
     "disc 3 at (0.5, 10.5) is left moving into a wall with velocity (-1, 0.5)"},
    {"DiscSlowedByItsWall", [](auto& discs) { discs[at_wall].vx = 0.9; },
     "disc 3 overlaps no other, yet its velocity changed from (-1, 0.5) to (0.9"},
    {"PairThatLostEnergy",
     [](auto& discs) {
         speed_up(discs[pair_first], 0.99);
         speed_up(discs[pair_second], 0.99);
     },
     "the group of 2 overlapping discs around disc 0 changed its energy by -"},
    {"PairThatLostALittleEnergy", [](auto& discs) { speed_up(discs[pair_second], 1 - 1e-9); },
     "the group of 2 overlapping discs around disc 0 changed its energy by -"},
    {"EnergyThatWentFromOneGroupToAnother",
     [](auto& discs) {
         const auto energy = [](const Disc& disc) { return disc.vx * disc.vx + disc.vy * disc.vy; };
         const double given = 0.01 * energy(discs[at_wall]);
         speed_up(discs[at_wall], std::sqrt(0.99));
         const double had = energy(discs[receding_second]);
         speed_up(discs[receding_second], std::sqrt((had + given) / had));
     },
     "disc 3 overlaps no other, yet its velocity changed from (-1, 0.5) to (0.99"},
    {"PairThatTurned", [](auto& discs) { turn_pair(discs, 0.01); },
     "the group of 2 overlapping discs around disc 0, away from walls, changed its momentum by "},
    {"PairThatTurnedALittle", [](auto& discs) { turn_pair(discs, 1e-9); },
     "the group of 2 overlapping discs around disc 0, away from walls, changed its momentum by "},
    {"PairThatExchangedWholeVelocities",
     [](auto& discs) {
         discs[pair_first].vx = before[pair_second].vx;
         discs[pair_first].vy = before[pair_second].vy;
         discs[pair_second].vx = before[pair_first].vx;
         discs[pair_second].vy = before[pair_first].vy;
     },
     "the group of 2 overlapping discs around disc 0, away from walls, changed its angular momentum"},
    {"LoneDiscThatTurned", [](auto& discs) { turn(discs[lone], 1e-9); },
     "disc 2 overlaps no other, yet its velocity changed from (1, -1) to (1"},
    {"LoneDiscThatTurnedBack", [](auto& discs) { speed_up(discs[lone], -1); },
     "disc 2 overlaps no other, yet its velocity changed from (1, -1) to (-1, 1)"},
    {"DiscAtAWallThatTurnedAlongIt", [](auto& discs) { discs[at_wall].vy = -0.5; }, "disc 3"},
    {"DiscAtAWallThatTurnedAnywhere", [](auto& discs) { turn(discs[at_wall], 0.25); }, "disc 3"},
    {"VelocityThatIsNotANumber",
     [](auto& discs) { discs[lone].vx = std::numeric_limits<double>::quiet_NaN(); },
     "disc 2 has a state that is not finite"},
    {"VelocityThatIsInfinite",
     [](auto& discs) { discs[pair_first].vy = std::numeric_limits<double>::infinity(); },
     "disc 0 has a state that is not finite"},
    {"PositionThatIsNotANumber",
     [](auto& discs) { discs[lone].y = std::numeric_limits<double>::quiet_NaN(); },
     "disc 2 moved from (35, 35)"}};

TEST(Checker, PassesARightStep) { EXPECT_EQ(violation(before, rightly_stepped()), ""); }

TEST(WrongStep, IsNamed) {
    for (const auto& [name, mutate, message] : mutants) {
        std::vector<Disc> after = rightly_stepped();
        mutate(after);
        EXPECT_PRED_FORMAT2(testing::IsSubstring, message, violation(before, after)) << name;
    }
}

TEST(Checker, PassesSpeedsWhoseSquaresUnderflow) {
    const Scene scene = tests::random_scene(60, side, radius, 1, 1, 102);
    for (const double factor : {1e-100, 1e-150, 1e-155, 1e-158, 1e-160, 1e-162, 1e-170, 1e-300}) {
        const Scene slow = tests::scaled(scene, 1, factor);
        EXPECT_EQ(violation(slow.discs, tests::simulate<Policies{}>(slow).discs), "")
            << "speeds times " << factor;
    }
}

TEST(Checker, PassesAStepOfAFractionOfTime) {
    State<> state({.side = side, .radius = radius, .steps = 1, .discs = before});
    NoProbe probe;
    step(state, {.substeps = 3}, probe);
    EXPECT_EQ(Checker(side, radius, 1.0 / 3, Tolerance::relative).step(before, state.discs), std::nullopt);
    EXPECT_NE(Checker(side, radius, 1.0 / 2, Tolerance::relative).step(before, state.discs), std::nullopt);
}

TEST(Checker, AllowsASlowApproachUnderThePublishedToleranceOnly) {
    const std::vector<Disc> discs{{20, 20, 0, 0}, {21, 20, -0.9e-7, 0}};
    const Checker published(side, radius, 1, Tolerance::published);
    const Checker relative(side, radius, 1, Tolerance::relative);
    EXPECT_EQ(published.colliding(discs), std::nullopt);
    EXPECT_NE(relative.colliding(discs), std::nullopt);
    EXPECT_NE(published.colliding({{20, 20, 0, 0}, {21, 20, -1.1e-7, 0}}), std::nullopt);
}

TEST(Checker, TakesCoincidentCentresForNoCollision) {
    EXPECT_EQ(Checker(side, radius, 1, Tolerance::relative).colliding({{9, 9, 1, 0}, {9, 9, -1, 0}}),
              std::nullopt);
}

TEST(KineticEnergy, IsHalfTheSumOfSquaredSpeeds) {
    EXPECT_EQ(kinetic_energy({}), 0);
    EXPECT_EQ(kinetic_energy({{1, 2, 3, 4}, {5, 6, -1, 0}}), 13);
}

} // namespace
} // namespace carom
