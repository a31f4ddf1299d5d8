#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

constexpr Policies in_float{.precision = Precision::float_};

TEST(Float, KeepsAndComputesInFloat) {
    // A third is no float and no double; after a step the position must be the float sum of floats.
    const Scene scene{.side = 50, .radius = 1, .steps = 1, .discs = {{10 + 1.0 / 3, 20, 1.0 / 3, 0}}};
    const auto discs = tests::simulate<in_float>(scene).discs;
    const float expected = static_cast<float>(10 + 1.0 / 3) + static_cast<float>(1.0 / 3);
    EXPECT_EQ(discs[0].x, static_cast<double>(expected));
    EXPECT_EQ(discs[0].vx, static_cast<double>(static_cast<float>(1.0 / 3)));
}

TEST(Float, EndsNearDoubleAsLongAsPathsStayTogether) {
    const Scene scene = tests::random_scene(60, 60, 1, 3, 1, 61);
    const auto in_double = tests::simulate<Policies{}>(scene);
    const auto narrow = tests::simulate<in_float>(scene);
    ASSERT_GT(in_double.work.pair_resolves, 0);
    for (std::size_t i = 0; i < scene.discs.size(); ++i) {
        EXPECT_NEAR(narrow.discs[i].x, in_double.discs[i].x, 1e-4);
        EXPECT_NEAR(narrow.discs[i].vx, in_double.discs[i].vx, 1e-4);
    }
    EXPECT_FALSE(tests::same_bits(narrow.discs, in_double.discs));
}

TEST(Float, SettlesInEveryScene) {
    for (const auto& [name, scene] : tests::all_scenes()) {
        SCOPED_TRACE(name);
        EXPECT_TRUE(tests::simulate<in_float>(scene).work.settled);
    }
}

} // namespace
} // namespace carom
