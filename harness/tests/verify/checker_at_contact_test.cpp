#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/verify/checker.hpp"
#include "kernels/exact/event_driven.hpp"
#include "kernels/tests/simulate.hpp"

// The checker of Impact::at_contact against steps of which none is made by the kernel: the event-driven
// simulation says what is right, and bugs are planted into that.

namespace carom::at_contact_step {
namespace {

constexpr double side = 50;
constexpr double radius = 1;

/// What the discs of `before` are there for. Three meet one after the other; the second pair meets nobody.
enum Role : std::size_t { pair_first, pair_second, lone, at_wall, at_corner, chain_first, chain, chain_last };

const std::vector<Disc> before{{20, 20, 0.5, 0.25}, {22, 21, -0.5, 0},      {35, 35, 1, -1},
                               {1.5, 10, -1, 0.5},  {48.75, 48.5, 0.5, 1},  {30, 8, 0.75, 0},
                               {32.25, 8, 0, 0.25}, {34.375, 9, -0.5, 0.25}};

const Scene scene{.side = side, .radius = radius, .steps = 1, .discs = before};

std::vector<Disc> rightly_stepped() {
    EventDriven<double> reference(scene);
    EXPECT_TRUE(reference.advance(1));
    EXPECT_EQ(reference.pair_collisions(), 3);
    EXPECT_EQ(reference.wall_collisions(), 3);
    std::vector<Disc> discs = reference.discs();
    discs[lone] = {36, 34, 1, -1};
    return discs;
}

Checker checker(double dt = 1) {
    return {side, radius, dt, Tolerance::relative, Rounding(), Impact::at_contact};
}

std::string violation(const std::vector<Disc>& end) { return checker().step(before, end).value_or(""); }

Disc flown_freely(Role disc) {
    const Disc& from = before[disc];
    return {from.x + from.vx, from.y + from.vy, from.vx, from.vy};
}

/// How far a disc was taken from the end of its free flight.
Disc way_back(const std::vector<Disc>& end, Role disc) {
    const Disc free = flown_freely(disc);
    return {end[disc].x - free.x, end[disc].y - free.y, 0, 0};
}

/// The normal components exchanged along the normal at the end of the step; and the way since the contact, of
/// which the right step tells how long ago it was, with the velocities that this gives.
void collide_along_last_normal(std::vector<Disc>& discs) {
    Disc one = flown_freely(pair_first);
    Disc two = flown_freely(pair_second);
    const double time = (discs[pair_first].x - one.x) / (discs[pair_first].vx - one.vx);
    const double dx = two.x - one.x;
    const double dy = two.y - one.y;
    const double impulse = ((two.vx - one.vx) * dx + (two.vy - one.vy) * dy) / (dx * dx + dy * dy);
    discs[pair_first] = {one.x + impulse * dx * time, one.y + impulse * dy * time, one.vx + impulse * dx,
                         one.vy + impulse * dy};
    discs[pair_second] = {two.x - impulse * dx * time, two.y - impulse * dy * time, two.vx - impulse * dx,
                          two.vy - impulse * dy};
}

void stay_where_flown(std::vector<Disc>& discs, Role disc) {
    discs[disc].x = flown_freely(disc).x;
    discs[disc].y = flown_freely(disc).y;
}

struct Mutant {
    std::string name;
    std::function<void(std::vector<Disc>&)> mutate;
    std::string message;
};

const std::vector<Mutant> mutants{
    {"WayBackOfTheWrongSign",
     [](auto& discs) {
         for (const Role disc : {pair_first, pair_second}) {
             const Disc way = way_back(discs, disc);
             discs[disc].x -= 2 * way.x;
             discs[disc].y -= 2 * way.y;
         }
     },
     " apart, are left approaching"},
    {"OnlyOneDiscMovedBack", [](auto& discs) { stay_where_flown(discs, pair_second); }, "discs 0 and 1"},
    {"NobodyMovedBack",
     [](auto& discs) {
         stay_where_flown(discs, pair_first);
         stay_where_flown(discs, pair_second);
     },
     "discs 0 and 1, which met with nothing else near, are at"},
    {"NormalOfTheStepsEnd", collide_along_last_normal, "discs 0 and 1"},
    {"PairUntouched",
     [](auto& discs) {
         discs[pair_first] = flown_freely(pair_first);
         discs[pair_second] = flown_freely(pair_second);
     },
     "are left approaching"},
    {"WallWithoutWayBack", [](auto& discs) { stay_where_flown(discs, at_wall); },
     "disc 3, which met no other, flew to"},
    {"WallAlongOneAxisOfACorner", [](auto& discs) { discs[at_corner].y = 49.5; },
     "disc 4, which met no other, flew to"},
    {"WallThatTurnsAndSlows", [](auto& discs) { discs[at_wall].vx *= 0.5; }, "disc 3, which met no other"},
    {"LoneDiscMoved", [](auto& discs) { discs[lone].x += 1e-9; }, "disc 2, which met no other"},
    {"LoneDiscTurned", [](auto& discs) { discs[lone].vx = -1; }, "disc 2, which met no other"},
    {"GroupThatGainsEnergy", [](auto& discs) { discs[chain].vy *= 1.001; }, "changed its energy"},
    {"GroupThatGainsMomentum", [](auto& discs) { std::swap(discs[chain].vx, discs[chain].vy); },
     "changed its momentum"},
    {"GroupWhoseCentreJumps", [](auto& discs) { discs[chain].y += 1e-6; }, "moved its centre of mass"},
    {"GroupThatTurns",
     [](auto& discs) {
         discs[chain_first].y += 1e-4;
         discs[chain_last].y -= 1e-4;
     },
     "changed its angular momentum"},
    {"StateNotFinite", [](auto& discs) { discs[chain].vx = std::nan(""); }, "not finite"},
};

TEST(WrongImpact, IsCaught) {
    for (const auto& [name, mutate, message] : mutants) {
        std::vector<Disc> after = rightly_stepped();
        mutate(after);
        EXPECT_PRED_FORMAT2(testing::IsSubstring, message, violation(after)) << name;
    }
}

TEST(CheckerAtContact, PassesARightStep) { EXPECT_EQ(violation(rightly_stepped()), ""); }

/// A disc that a collision moves into a third one, which it did not overlap before, may stay so until the
/// next step.
TEST(CheckerAtContact, LeavesWhatWasMovedTogetherToTheNextStep) {
    std::vector<Disc> start = before;
    std::vector<Disc> end = rightly_stepped();
    const Disc free = flown_freely(pair_first);
    const Disc way = way_back(end, pair_first);
    const double length = std::hypot(way.x, way.y);
    ASSERT_GT(length, 0.1);
    const double gap = 0.01;
    const Disc third{free.x + way.x / length * (2 * radius + gap),
                     free.y + way.y / length * (2 * radius + gap), -way.x / length, -way.y / length};
    start.push_back({third.x - third.vx, third.y - third.vy, third.vx, third.vy});
    end.push_back({start.back().x + third.vx, start.back().y + third.vy, third.vx, third.vy});
    EXPECT_NE(checker().colliding(end), std::nullopt);
    EXPECT_EQ(checker().step(start, end), std::nullopt);
}

TEST(CheckerAtContact, KnowsStepsOfAFractionOfTime) {
    EventDriven<double> reference(scene);
    ASSERT_TRUE(reference.advance(0.75));
    std::vector<Disc> end = reference.discs();
    end[lone] = {35.75, 34.25, 1, -1};
    EXPECT_EQ(checker(0.75).step(before, end), std::nullopt);
    EXPECT_NE(checker(0.5).step(before, end), std::nullopt);
}

// In a large box two floats round by more than what is left to fly at the end of a step.

constexpr double large = 44'840;
constexpr double large_radius = 16;
constexpr double quarter = 0.25;
const Rounding to_float(std::numeric_limits<float>::epsilon());

/// Two discs in the large box that are near each other at the end of a step, one of them moved by `shift`.
std::vector<Disc> nearly_met(double shift) {
    return {{40'846.359375, 7'159.63427734375, 0.328125, 2.328125},
            {40'877.41796875 + shift, 7'172.13818359375, -4.125, -2.5}};
}

std::vector<Disc> flown_on(std::vector<Disc> discs) {
    for (Disc& disc : discs) {
        disc.x = to_float(disc.x + disc.vx * quarter);
        disc.y = to_float(disc.y + disc.vy * quarter);
    }
    return discs;
}

double distance_of_both(const std::vector<Disc>& discs) {
    return std::hypot(discs[1].x - discs[0].x, discs[1].y - discs[0].y);
}

/// Exchanges what they have along the line between them, where they are.
std::vector<Disc> collided(std::vector<Disc> discs) {
    const double nx = (discs[1].x - discs[0].x) / distance_of_both(discs);
    const double ny = (discs[1].y - discs[0].y) / distance_of_both(discs);
    const double exchanged = (discs[1].vx - discs[0].vx) * nx + (discs[1].vy - discs[0].vy) * ny;
    for (const double sign : {1.0, -1.0}) {
        Disc& disc = sign > 0 ? discs[0] : discs[1];
        disc.vx = to_float(disc.vx + sign * exchanged * nx);
        disc.vy = to_float(disc.vy + sign * exchanged * ny);
    }
    return discs;
}

TEST(CheckerAtContact, LetsRoundingDecideWhetherAPairMetAtTheEndOfTheStep) {
    const Checker floats(large, large_radius, quarter, Tolerance::relative, to_float, Impact::at_contact);
    int apart = 0;
    for (int shift = -4; shift <= 4; ++shift) {
        const std::vector<Disc> start = nearly_met(shift / 256.0);
        const std::vector<Disc> free = flown_on(start);
        EXPECT_EQ(floats.step(start, collided(free)), std::nullopt) << shift;
        if (distance_of_both(free) > 2 * large_radius) {
            EXPECT_EQ(floats.step(start, free), std::nullopt) << shift;
            ++apart;
        }
    }
    EXPECT_GT(apart, 0);
    EXPECT_LT(apart, 9);
}

/// Two that met just before the end of the step were moved by less than a rounding. The normal of their
/// contact is another one than that of the places to which they were rounded.
TEST(CheckerAtContact, KnowsThatADiscIsMovedByLessThanARounding) {
    const Checker floats(4 * large, large_radius, quarter, Tolerance::relative, to_float, Impact::at_contact);
    for (int shift = -40; shift <= 40; ++shift) {
        std::vector<Disc> start = nearly_met(-2.0 / 256);
        for (Disc& disc : start) {
            disc.x += 3 * large;
            disc.y += 3 * large;
        }
        start[0].vy += shift / 256.0;
        start[1].vx -= shift / 256.0;
        const std::vector<Disc> free = flown_on(start);
        std::vector<Disc> met = start;
        for (Disc& disc : met) { // in double
            disc.x += disc.vx * quarter;
            disc.y += disc.vy * quarter;
        }
        met = collided(met);
        for (std::size_t i = 0; i < met.size(); ++i) {
            met[i].x = free[i].x;
            met[i].y = free[i].y;
        }
        EXPECT_EQ(floats.step(start, met), std::nullopt) << shift;
    }
}

TEST(CheckerAtContact, LetsRoundingDecideNothingWhereAPairIsApart) {
    const Checker floats(large, large_radius, quarter, Tolerance::relative, to_float, Impact::at_contact);
    for (const double gap : {0.1, 0.5, 2.0}) {
        const std::vector<Disc> start = nearly_met(gap);
        const std::vector<Disc> free = flown_on(start);
        EXPECT_EQ(floats.step(start, free), std::nullopt) << gap;
        EXPECT_PRED_FORMAT2(testing::IsSubstring, "which met with nothing else near",
                            floats.step(start, collided(free)).value_or(""))
            << gap;
    }
}

/// What collides at the end of the step is no step at contact, and the other way round.
TEST(CheckerAtContact, TakesNeitherKindOfStepForTheOther) {
    const Checker at_end(side, radius, 1, Tolerance::relative);
    EXPECT_NE(at_end.step(before, rightly_stepped()), std::nullopt);
    const auto resolved = tests::simulate<Policies{}>(scene).discs;
    EXPECT_EQ(at_end.step(before, resolved), std::nullopt);
    EXPECT_NE(checker().step(before, resolved), std::nullopt);
}

} // namespace
} // namespace carom::at_contact_step
