#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/measure.hpp"
#include "harness/scenes/generate.hpp"
#include "harness/support/errors.hpp"
#include "harness/verify/overlapping_pairs.hpp"

namespace carom {
namespace {

GeneratorArguments at_fraction(double fraction, int count, Placement placement) {
    return {.count = count,
            .side = std::sqrt(count * std::numbers::pi / fraction),
            .radius = 1,
            .steps = 3,
            .least_velocity = 1,
            .largest_velocity = 2,
            .seed = 5,
            .placement = placement};
}

/// Neither a disc nor a wall is touched.
void expect_apart(const Scene& scene) {
    EXPECT_TRUE(overlapping_pairs(scene.discs, scene.radius).empty());
    for (const Disc& disc : scene.discs) {
        for (const double position : {disc.x, disc.y}) {
            EXPECT_GE(position, scene.radius);
            EXPECT_LE(position, scene.side - scene.radius);
        }
    }
}

std::string refusal(const GeneratorArguments& arguments) {
    try {
        generate(arguments);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(RandomPlacement, KeepsDiscsApartUpToItsLimit) {
    for (const double fraction : {0.01, 0.2, 0.5}) {
        SCOPED_TRACE(fraction);
        const Scene scene = generate(at_fraction(fraction, 2000, Placement::random));
        EXPECT_EQ(scene.discs.size(), 2000u);
        EXPECT_NEAR(area_fraction(scene), fraction, 1e-12);
        expect_apart(scene);
    }
}

/// Jamming is at 0.547; walls, which centres keep r away from, take some of it in a box of 60 r.
TEST(RandomPlacement, SaysWhatItReachedBeyondItsLimit) {
    const std::string message = refusal(at_fraction(0.6, 700, Placement::random));
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "--placement random: found room for ", message);
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "of 700 discs in 700000 trials", message);
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "lattice", message);
    const auto place = message.find("area fraction ");
    ASSERT_NE(place, std::string::npos);
    const double reached = std::stod(message.substr(place + 14));
    EXPECT_GT(reached, 0.49);
    EXPECT_LT(reached, 0.56);
}

TEST(LatticePlacement, KeepsDiscsApartFromDiluteToDense) {
    for (const double fraction : {0.001, 0.3, 0.6, 0.8, 0.88}) {
        for (const int count : {1, 2, 3, 7, 100, 3000}) {
            const GeneratorArguments arguments = at_fraction(fraction, count, Placement::lattice);
            SCOPED_TRACE(testing::Message() << count << " discs at " << fraction);
            if (const std::string message = refusal(arguments); !message.empty()) {
                EXPECT_TRUE(count < 3000 && fraction >= 0.6) << message;
                continue;
            }
            const Scene scene = generate(arguments);
            EXPECT_EQ(scene.discs.size(), static_cast<std::size_t>(count));
            expect_apart(scene);
        }
    }
}

TEST(LatticePlacement, SaysHowManyDiscsFit) {
    const GeneratorArguments dense = at_fraction(0.9, 500, Placement::lattice);
    const std::string message = refusal(dense);
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "found 500 discs (area fraction 0.9000), expected at most ",
                        message);
    GeneratorArguments fitting = dense;
    fitting.count = std::stoi(message.substr(message.find("at most ") + 8));
    EXPECT_GT(fitting.count, 440);
    EXPECT_EQ(refusal(fitting), "");
}

TEST(Placement, GivesTheSameDiscsOnEveryPlatform) {
    EXPECT_EQ(state_hash(generate(at_fraction(0.3, 1000, Placement::random)).discs), "18e8a3543017171d");
    GeneratorArguments arguments = at_fraction(0.7, 1000, Placement::lattice);
    arguments.isotropic = true;
    EXPECT_EQ(state_hash(generate(arguments).discs), "308f3b238635f3b0");
}

TEST(Placement, TakesNoDiscs) {
    for (const Placement placement : {Placement::random, Placement::lattice}) {
        GeneratorArguments arguments = at_fraction(0.3, 10, placement);
        arguments.count = 0;
        EXPECT_TRUE(generate(arguments).discs.empty());
    }
}

TEST(IsotropicVelocities, PointEverywhereWithSpeedsInTheRange) {
    GeneratorArguments arguments = at_fraction(0.3, 20'000, Placement::overlapping);
    arguments.isotropic = true;
    double sum_vx = 0;
    double sum_speed = 0;
    std::vector<int> octants(8);
    for (const Disc& disc : generate(arguments).discs) {
        const double speed = std::hypot(disc.vx, disc.vy);
        ASSERT_GE(speed, 1 - 1e-15);
        ASSERT_LE(speed, 2 + 1e-15);
        sum_vx += disc.vx;
        sum_speed += speed;
        const double turn = std::atan2(disc.vy, disc.vx) / (2 * std::numbers::pi) + 0.5;
        ++octants[static_cast<std::size_t>(std::min(turn * 8, 7.0))];
    }
    EXPECT_NEAR(sum_vx / 20'000, 0, 0.05);
    EXPECT_NEAR(sum_speed / 20'000, 1.5, 0.01);
    for (const int count : octants) {
        EXPECT_NEAR(count, 2500, 250) << "five standard deviations";
    }
}

} // namespace
} // namespace carom
