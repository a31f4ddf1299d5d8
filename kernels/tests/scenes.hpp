#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "kernels/scene.hpp"

namespace carom::tests {

/// Random numbers that are the same on every platform.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// Uniform in [least, largest).
    double uniform(double least, double largest) {
        return least + static_cast<double>(engine_() >> 11) * 0x1p-53 * (largest - least);
    }

    /// 10 to a power uniform in [least, largest).
    double magnitude(double least, double largest) { return std::pow(10, uniform(least, largest)); }

    int below(int end) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(end)); }

    bool coin() { return (engine_() >> 63) != 0; }

  private:
    std::mt19937_64 engine_;
};

/// Discs at random places of the box, overlapping or not, with velocity components in [-speed, speed).
inline Scene random_scene(int count, double side, double radius, int steps, double speed,
                          std::uint64_t seed) {
    Random random(seed);
    Scene scene{.side = side, .radius = radius, .steps = steps, .discs = {}};
    for (int i = 0; i < count; ++i) {
        const double x = random.uniform(0, side);
        const double y = random.uniform(0, side);
        const double vx = random.uniform(-speed, speed);
        scene.discs.push_back({x, y, vx, random.uniform(-speed, speed)});
    }
    return scene;
}

/// Discs of radius 1 on a square lattice, none touching, with random velocity components in [-1, 1).
inline Scene lattice_scene(int per_side, double area_fraction, std::uint64_t seed) {
    const double side = std::sqrt(per_side * per_side * std::numbers::pi / area_fraction);
    const double spacing = side / per_side;
    Random random(seed);
    Scene scene{.side = side, .radius = 1, .steps = 1, .discs = {}};
    for (int row = 0; row < per_side; ++row) {
        for (int column = 0; column < per_side; ++column) {
            const double vx = random.uniform(-1, 1);
            scene.discs.push_back(
                {spacing * (column + 0.5), spacing * (row + 0.5), vx, random.uniform(-1, 1)});
        }
    }
    return scene;
}

/// Rows of a lattice that meet, and walls that are met, at one instant.
inline Scene tied_scene(int per_side) {
    Scene scene = lattice_scene(per_side, 0.5, 1);
    for (std::size_t i = 0; i < scene.discs.size(); ++i) {
        scene.discs[i].vx = i % 2 == 0 ? 1 : -1;
        scene.discs[i].vy = i % 3 == 0 ? 0.5 : 0;
    }
    return scene;
}

/// Random discs whose areas add up to `area_fraction` of the box's.
inline Scene random_scene_of_density(int count, double area_fraction, int steps, std::uint64_t seed) {
    const double side = std::sqrt(count * std::numbers::pi / area_fraction);
    return random_scene(count, side, 1, steps, 1, seed);
}

/// Random discs in a box so small that the grid has one box, which holds them in the order of their numbers.
inline Scene one_box_scene(std::uint64_t seed) { return random_scene(30, 1.15, 0.05, 40, 0.05, seed); }

/// Newton's cradle: one disc runs into a row of four at rest, nearly touching.
inline Scene cradle() {
    Scene scene{.side = 16, .radius = 1, .steps = 60, .discs = {{3, 5, 0.25, 0}}};
    for (int i = 0; i < 4; ++i) {
        scene.discs.push_back({5.125 + 2.0625 * i, 5, 0, 0});
    }
    return scene;
}

/// One disc that runs into a corner along the diagonal, and into the opposite one.
inline Scene corner() { return {.side = 10, .radius = 1, .steps = 25, .discs = {{4, 4, -1, -1}}}; }

/// Discs that start beyond all four walls, near and far, moving inwards, outwards and along.
inline Scene outside() {
    return {.side = 30,
            .radius = 1,
            .steps = 25,
            .discs = {{-5, 15, 1, 0},
                      {-40, 15.5, 2.5, 0.1},
                      {33, 14, -0.5, 0.25},
                      {15, -3, 0, -1},
                      {15.5, 34, 0, 1},
                      {-3, -3, 0.75, 0.5},
                      {-4, -4, 1, 1},
                      {32, 32, -1, -0.5},
                      {32.5, 33, 0, -1},
                      {31, -2, 0.3, 0.3},
                      {60, 15, -4, 0},
                      {15, 15, 0.5, -0.5}}};
}

/// A disc that comes back from so far outside that its position has lost half its digits.
inline Scene far_outside() {
    return {.side = 30, .radius = 1, .steps = 25, .discs = {{1e7, 15, -1e6, 0}, {15, 15, 0.5, -0.5}}};
}

/// Clusters of discs on top of each other, three of them with the same centre, some of them at rest.
inline Scene overlapping_starts() {
    Scene scene = random_scene(40, 60, 2, 20, 1, 71);
    for (std::size_t i = 0; i + 1 < scene.discs.size(); i += 2) {
        scene.discs[i + 1].x = scene.discs[i].x + 0.5;
        scene.discs[i + 1].y = scene.discs[i].y - 0.25;
    }
    return scene;
}

/// Discs whose centres coincide, at the start or after a step, beside others that overlap them.
inline Scene coincident() {
    return {.side = 40,
            .radius = 2,
            .steps = 10,
            .discs = {{20, 20, 1, 0},
                      {20, 20, -1, 0},
                      {20, 20, 0, 0.5},
                      {21, 20, 0, 0},
                      {8, 8, 1, 0},
                      {10, 8, -1, 0},
                      {30, 9, 0, 0},
                      {30, 9, 0, 0}}};
}

/// The same scene with all lengths times `length` and all velocities times `velocity`.
inline Scene scaled(Scene scene, double length, double velocity) {
    scene.side *= length;
    scene.radius *= length;
    for (Disc& disc : scene.discs) {
        disc.x *= length;
        disc.y *= length;
        disc.vx *= velocity;
        disc.vy *= velocity;
    }
    return scene;
}

struct NamedScene {
    std::string name;
    Scene scene;
};

/// What every variant must get right: plain scenes and awkward ones, all of them small.
inline std::vector<NamedScene> all_scenes() {
    const Scene plain = random_scene(200, 60, 1, 12, 3, 1);
    return {{"random", plain},
            {"random of another density", random_scene(150, 90, 1, 20, 2, 2)},
            {"one box", one_box_scene(3)},
            {"cradle", cradle()},
            {"corner", corner()},
            {"dense", random_scene_of_density(300, 0.9, 10, 4)},
            {"dense, another", random_scene_of_density(300, 0.9, 10, 5)},
            {"outside", outside()},
            {"far outside", far_outside()},
            {"overlapping starts", overlapping_starts()},
            {"coincident", coincident()},
            {"many boxes a step", random_scene(200, 60, 1, 12, 1e4, 6)},
            {"beyond the precision of positions", random_scene(50, 60, 1, 6, 1e17, 7)},
            {"no disc", {.side = 10, .radius = 1, .steps = 3, .discs = {}}},
            {"one disc", random_scene(1, 10, 1, 30, 2, 8)},
            {"at rest", random_scene(100, 40, 1, 3, 0, 9)},
            {"scaled by 2^-20", scaled(plain, 0x1p-20, 0x1p-20)},
            {"scaled by 2^20", scaled(plain, 0x1p20, 0x1p20)},
            {"scaled by 1e-58", scaled(plain, 1e-58, 1e-58)},
            {"scaled by 1e57", scaled(plain, 1e57, 1e57)}};
}

} // namespace carom::tests
