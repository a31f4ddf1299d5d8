#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "harness/measure/measure.hpp"
#include "harness/scenes/generate.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

using tests::same_bits;

GeneratorArguments small(std::uint64_t seed) {
    return {.count = 3,
            .side = 100,
            .radius = 1,
            .steps = 9,
            .least_velocity = -2,
            .largest_velocity = 5,
            .seed = seed};
}

TEST(Generate, StandsOnTheEngineThatTheStandardFixes) {
    std::mt19937_64 engine;
    engine.discard(9'999);
    EXPECT_EQ(engine(), 9981545732273789042u);
}

TEST(Generate, GivesTheSameDiscsOnEveryPlatform) {
    // Worked out by another program from Matsumoto and Nishimura's definition of the 64-bit Mersenne Twister.
    const std::vector<Disc> expected{
        {0x1.ac67bf2ca6991p+3, 0x1.b480a4e9b6b82p+3, 0x1.2893bd545c4bcp+0, -0x1.da5317d9af87cp+0},
        {0x1.18b7ef072494bp+5, 0x1.6c8b106941f65p+6, 0x1.4b967b76f982cp+0, -0x1.7aa15d303c670p+0},
        {0x1.c7e0b2309b7bbp+5, 0x1.fc2f5a7fac961p+5, -0x1.5fb32b236a07ap+0, 0x1.e4ac2ead30fb4p+0}};
    EXPECT_TRUE(same_bits(generate(small(1)).discs, expected));
}

TEST(Generate, GivesTheSameThousandDiscsOnEveryPlatform) {
    const Scene scene = generate({.count = 1000,
                                  .side = 10'000,
                                  .radius = 16,
                                  .steps = 100,
                                  .least_velocity = 2,
                                  .largest_velocity = 5,
                                  .seed = 7});
    EXPECT_EQ(state_hash(scene.discs), "38cb40fd1763c02b");
}

TEST(Generate, TakesTheLargestSeed) {
    GeneratorArguments arguments = small(UINT64_MAX);
    arguments.count = 2;
    EXPECT_EQ(state_hash(generate(arguments).discs), "f427abf1d782ca32");
}

TEST(Generate, GivesAnotherSceneForAnotherSeedAndTheSameForTheSame) {
    EXPECT_TRUE(same_bits(generate(small(5)).discs, generate(small(5)).discs));
    EXPECT_FALSE(same_bits(generate(small(5)).discs, generate(small(6)).discs));
}

TEST(Generate, PassesOnTheOtherArguments) {
    const Scene scene = generate(small(1));
    EXPECT_EQ(scene.side, 100);
    EXPECT_EQ(scene.radius, 1);
    EXPECT_EQ(scene.steps, 9);
    EXPECT_EQ(scene.discs.size(), 3u);
}

TEST(Generate, FillsTheRangesThatItIsGiven) {
    GeneratorArguments arguments = small(2);
    arguments.count = 20'000;
    double sum_x = 0;
    double sum_vx = 0;
    for (const Disc& disc : generate(arguments).discs) {
        for (const double position : {disc.x, disc.y}) {
            ASSERT_GE(position, 0);
            ASSERT_LT(position, 100);
        }
        for (const double velocity : {disc.vx, disc.vy}) {
            ASSERT_GE(velocity, -2);
            ASSERT_LE(velocity, 5);
        }
        sum_x += disc.x;
        sum_vx += disc.vx;
    }
    EXPECT_NEAR(sum_x / arguments.count, 50, 1);
    EXPECT_NEAR(sum_vx / arguments.count, 1.5, 0.07);
}

TEST(Generate, GivesEveryDiscTheSameVelocityInAnEmptyRange) {
    GeneratorArguments arguments = small(3);
    arguments.least_velocity = arguments.largest_velocity = 0.1;
    for (const Disc& disc : generate(arguments).discs) {
        EXPECT_EQ(disc.vx, 0.1);
        EXPECT_EQ(disc.vy, 0.1);
    }
}

} // namespace
} // namespace carom
