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
    GeneratorArguments largest_seed = small(UINT64_MAX);
    largest_seed.count = 2;
    EXPECT_EQ(state_hash(generate(largest_seed).discs), "f427abf1d782ca32");
}

TEST(Generate, PassesOnTheOtherArguments) {
    const Scene scene = generate(small(1));
    EXPECT_EQ(scene.side, 100);
    EXPECT_EQ(scene.radius, 1);
    EXPECT_EQ(scene.steps, 9);
    EXPECT_EQ(scene.discs.size(), 3u);
}

} // namespace
} // namespace carom
