#include "harness/scenes/hard_cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "harness/scenes/changed_scenes.hpp"
#include "harness/scenes/generate.hpp"
#include "kernels/exact/event_driven.hpp"

namespace carom {
namespace {

/// Newton's cradle: a disc runs into a row of four at rest with small gaps. Equal discs exchange their
/// velocities head-on (Landau and Lifshitz, Mechanics, section 17), so exactly one of the five moves at any
/// time. Hard: several collisions within one unit of time.
Scene cradle() {
    Scene scene{.side = 16, .radius = 1, .steps = 60, .discs = {{3, 5, 0.25, 0}}};
    for (int i = 0; i < 4; ++i) {
        scene.discs.push_back({5.125 + 2.0625 * i, 5, 0, 0});
    }
    return scene;
}

/// A disc that touches both walls of a corner at the end of a step, to the last bit, and then those of the
/// opposite one. Hard: two walls at once, and "touches" decides.
Scene corner() { return {.side = 10, .radius = 1, .steps = 25, .discs = {{4, 4, -1, -1}}}; }

/// A disc that rests at a wall is struck against it, another one in a corner. Hard: what the disc passes to
/// the wall comes back through it, all within one resolve; the pinned disc ends at rest and the striker
/// returns with its speed.
Scene pinned() {
    return {.side = 16,
            .radius = 1,
            .steps = 10,
            .discs = {{1, 10, 0, 0}, {3.5, 10, -1, 0}, {1, 1, 0, 0}, {3, 3, -0.75, -0.75}}};
}

/// A cue disc breaks a triangle of fifteen, 4e-6 r apart, along its axis of symmetry. Hard: the apex strikes
/// two discs at once, and what then happens depends on which is resolved first (Smith, Kaufman, Vouga,
/// Tamstorf and Grinspun, Reflections on Simultaneous Impact, ACM Trans. Graph. 31, 106, 2012): a method
/// that resolves pair by pair breaks the symmetry.
Scene rack_break() {
    constexpr double middle = 32;
    constexpr double row_spacing = 113512 * 0x1p-16; // the square root of 3, rounded up
    Scene scene{.side = 64, .radius = 1, .steps = 40, .discs = {{26.25, middle, 0.75, 0}}};
    for (int row = 0; row < 5; ++row) {
        for (int k = 0; k <= row; ++k) {
            scene.discs.push_back({36 + row_spacing * row, middle + 2 * k - row, 0, 0});
        }
    }
    return scene;
}

/// One disc strikes two that touch, both in the same step and at the same depth. Hard: the conservation laws
/// alone do not fix the outcome (Chatterjee and Ruina, J. Appl. Mech. 65, 939, 1998); resolving pair by pair
/// gives one of two mirror images.
Scene three_body() {
    return {.side = 64, .radius = 3, .steps = 4, .discs = {{24, 32, 4, 0}, {32, 29, 0, 0}, {32, 35, 0, 0}}};
}

/// Centres that coincide at the start, that stay together, and that come to coincide at the end of a step.
/// Hard: they have no normal to collide along.
Scene coincident() {
    return {.side = 40,
            .radius = 2,
            .steps = 5,
            .discs = {{10, 10, 1, 0},
                      {10, 10, -1, 0},
                      {10, 25, 0.5, 0},
                      {10, 25, 0.5, 0},
                      {25, 10, 1, 0},
                      {27, 10, -1, 0},
                      {25, 25, 1, 0},
                      {25, 25, -1, 0},
                      {25, 25, 0, 0.5}}};
}

/// Centres that come to be 2^-40 r (about 1e-12 r) apart, head-on and oblique; at a distance whose square is
/// just no underflow; and at one that is denormal itself. Hard: the impulse is a quotient of squares.
Scene nearly_coincident() {
    constexpr double near = 0x1p-40;
    constexpr double square_in_range = 0x1p-480;
    constexpr double denormal = 0x1p-1071;
    return {.side = 16,
            .radius = 1,
            .steps = 2,
            .discs = {{4, 4, 0, 0},
                      {5 + near, 4, -1, 0},
                      {4, 10, 0, 0},
                      {5 + near, 10 - near, -1, 0},
                      {0, 13, square_in_range, 0},
                      {2 * square_in_range, 13, 0, 0},
                      {0, 7, denormal, 0},
                      {2 * denormal, 7, 0, 0}}};
}

/// Discs that pass resting ones at a distance of 2r, a rounding less, a rounding more, and a rounding more
/// that |d|^2 loses. Hard: the last bit decides about contact. It hardly decides about the outcome: at a
/// distance within u of 2r a disc can approach by no more than the square root of u of its speed.
Scene grazing() {
    constexpr double beside = 0x1p-27; // so that beside^2 is a rounding of (2r)^2 = 1/4
    Scene scene{.side = 16, .radius = 0.25, .steps = 4, .discs = {}};
    struct Pass {
        double height;
        double before;
    };
    double x = 1.5;
    for (const auto& [height, before] : {Pass{1 - 0x1p-53, beside}, Pass{1, 0}, Pass{1 + 0x1p-52, beside},
                                         Pass{1, beside}, Pass{1, beside / 2}}) {
        scene.discs.push_back({x, 0.5, 0, 0});
        scene.discs.push_back({x - 0.5 - before, height, 0.5, 0});
        x += 3;
    }
    return scene;
}

/// A hexagonal lattice at an area fraction of 0.9 away from the walls, each disc with some speed. Hard: every
/// disc is caged, and a step makes many contacts at once.
Scene jammed() {
    const double spacing = std::sqrt(2 * std::numbers::pi / (std::numbers::sqrt3 * 0.9));
    constexpr int columns = 20;
    const double side = spacing * (columns + 0.5);
    const int rows = static_cast<int>((columns - 0.5) / (std::numbers::sqrt3 / 2)) + 1;
    RandomNumbers random(9);
    Scene scene{.side = side, .radius = 1, .steps = 50, .discs = {}};
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const double vx = random.uniform(-0.05, 0.05);
            scene.discs.push_back({spacing * (column + (row % 2 == 0 ? 0.5 : 1.0)),
                                   spacing / 2 + (side - spacing) / (rows - 1) * row, vx,
                                   random.uniform(-0.05, 0.05)});
        }
    }
    return scene;
}

/// A hexagon of 61 discs in hexagonal close packing, each touching up to six, all moving at random, far from
/// the walls. Hard: 156 contacts in one cluster. They end: at fixed positions the resolves are reflections at
/// the faces of a cone of velocities that has an inside (all fly apart), and of those a path makes finitely
/// many (Burago, Ferleger and Kononenko, Ann. of Math. 147, 695, 1998).
Scene hexagonal() {
    constexpr int shells = 4;
    constexpr double row_spacing = 113511 * 0x1p-16; // the square root of 3, rounded down
    RandomNumbers random(10);
    Scene scene{.side = 64, .radius = 1, .steps = 20, .discs = {}};
    for (int row = -shells; row <= shells; ++row) {
        const int count = 2 * shells + 1 - std::abs(row);
        for (int k = 0; k < count; ++k) {
            const double vx = random.uniform(-0.25, 0.25);
            scene.discs.push_back(
                {32.0 + 2 * k - (count - 1), 32 + row_spacing * row, vx, random.uniform(-0.25, 0.25)});
        }
    }
    return scene;
}

/// Discs that fly 20 to 40 box lengths in a step. Hard: they fly through each other (tunnelling) and far out
/// of the box; a method with steps is wrong by nature here, and must neither hang nor lose energy.
Scene fast() {
    return generate({.count = 60,
                     .side = 60,
                     .radius = 1,
                     .steps = 10,
                     .least_velocity = 20 * 60,
                     .largest_velocity = 40 * 60,
                     .seed = 11,
                     .placement = Placement::random,
                     .isotropic = true});
}

/// Overlapping discs, two of them coincident and some beyond the walls, none of which moves. Hard: nothing
/// may change, not by a bit.
Scene at_rest() {
    Scene scene = generate({.count = 100,
                            .side = 40,
                            .radius = 2,
                            .steps = 5,
                            .least_velocity = 0,
                            .largest_velocity = 0,
                            .seed = 12});
    scene.discs.push_back(scene.discs.front());
    scene.discs.push_back({-3, 50, 0, 0});
    return scene;
}

/// Two discs that meet head-on at x = 9e7 r, and one that turns in the far corner, L = 1e8 r. Hard: a float's
/// neighbour there is 8 r away, so that none of these moves at all; a double's is 1.5e-8 r away.
Scene far_coordinates() {
    return {.side = 1e8,
            .radius = 1,
            .steps = 5,
            .discs = {{9e7, 9e7, 0.7, 0}, {9e7 + 4, 9e7, -0.7, 0}, {1e8 - 3.5, 1e8 - 3.5, 1, 0.75}}};
}

/// A hundred discs at an area fraction of 0.3 for 100 000 steps. Hard: what rounding adds at each of a
/// million collisions must not add up.
Scene drift() {
    return generate({.count = 100,
                     .side = 32,
                     .radius = 1,
                     .steps = 100'000,
                     .least_velocity = 0.25,
                     .largest_velocity = 0.5,
                     .seed = 13,
                     .placement = Placement::lattice,
                     .isotropic = true});
}

/// Where plain_scene is after its steps, exactly, with all velocities reversed: as many steps later it is to
/// be where plain_scene starts. Hard: rounding grows at every collision, and a step is late at each.
Scene reversed() {
    Scene scene = plain_scene();
    EventDriven<long double> reference(scene);
    reference.advance(scene.steps);
    std::ranges::transform(reference.discs(), scene.discs.begin(), [](const auto& disc) {
        return Disc{static_cast<double>(disc.x), static_cast<double>(disc.y), static_cast<double>(disc.vx),
                    static_cast<double>(disc.vy)};
    });
    return turned_back(scene);
}

/// Scaled: powers of two change no digit of a number: the discs do the same, times the factor, to the last
/// bit. Hard for whatever knows an absolute length: a tolerance, or a box side such as the published 4r + 1,
/// which changes the order in which discs are visited. This scene has no order to choose; others have.
/// Renumbered, mirrored, rotated: what depends on the discs' numbers or on which axis is which shows there.
constexpr std::array cases{
    HardCase{"cradle", "Newton's cradle: several collisions within one unit of time", cradle},
    HardCase{"corner", "one disc that touches two walls at once, to the last bit", corner},
    HardCase{"pinned", "discs struck while they rest at a wall and in a corner", pinned},
    HardCase{"rack_break", "fifteen discs broken along their axis of symmetry", rack_break},
    HardCase{"three_body", "one disc strikes two at once", three_body},
    HardCase{"coincident", "centres that coincide: no normal to collide along", coincident},
    HardCase{"nearly_coincident", "centres 1e-12 r apart, and by a denormal number", nearly_coincident},
    HardCase{"grazing", "discs that pass at 2r, give or take a rounding", grazing},
    HardCase{"jammed", "a hexagonal lattice at area fraction 0.9, every disc caged", jammed},
    HardCase{"hexagonal", "hexagonal close packing: 156 contacts in one cluster", hexagonal},
    HardCase{"fast", "20 to 40 box lengths a step: tunnelling, and far outside the box", fast},
    HardCase{"at_rest", "overlapping discs that do not move: nothing may change", at_rest},
    HardCase{"one_disc", "one disc alone with the walls",
             [] { return Scene{.side = 10, .radius = 1, .steps = 100, .discs = {{5, 5, 0.75, 0.3125}}}; }},
    HardCase{"no_discs", "no disc at all",
             [] { return Scene{.side = 10, .radius = 1, .steps = 10, .discs = {}}; }},
    HardCase{"scaled_down", "a plain scene with all lengths times 2^-20",
             [] { return scaled(plain_scene(), 0x1p-20); }},
    HardCase{"scaled_up", "a plain scene with all lengths times 2^20",
             [] { return scaled(plain_scene(), 0x1p20); }},
    HardCase{"far_coordinates", "L/r = 1e8: coordinates that leave a float no radius", far_coordinates},
    HardCase{"drift", "a hundred discs for 100 000 steps: a million collisions", drift},
    HardCase{"reversed", "the end of a plain scene with all velocities reversed: the way back", reversed},
    HardCase{"renumbered", "a plain scene with its discs in the opposite order",
             [] { return renumbered(plain_scene()); }},
    HardCase{"mirrored", "a plain scene mirrored at the box's diagonal",
             [] { return mirrored(plain_scene()); }},
    HardCase{"rotated", "a plain scene after a quarter turn", [] { return rotated(plain_scene()); }}};

/// To a multiple of 2^-16, which a float holds, too, up to 256.
double coarse(double value) { return std::round(value * 0x1p16) * 0x1p-16; }

} // namespace

std::span<const HardCase> hard_cases() { return cases; }

const HardCase* find_hard_case(std::string_view name) {
    const auto found = std::ranges::find(cases, name, &HardCase::name);
    return found == cases.end() ? nullptr : &*found;
}

Scene plain_scene() {
    Scene scene = generate({.count = 80,
                            .side = 96,
                            .radius = 1,
                            .steps = 40,
                            .least_velocity = 0.25,
                            .largest_velocity = 0.75,
                            .seed = 23,
                            .placement = Placement::lattice,
                            .isotropic = true});
    for (Disc& disc : scene.discs) {
        disc = {coarse(disc.x), coarse(disc.y), coarse(disc.vx), coarse(disc.vy)};
    }
    return scene;
}

} // namespace carom
