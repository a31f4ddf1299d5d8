#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/collide.hpp"
#include "kernels/four_at_once.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"

namespace carom {
namespace {

TEST(Filter, DropsNoPairThatOverlaps) {
    tests::Random random(73);
    int dropped = 0;
    for (int trial = 0; trial < 200'000; ++trial) {
        const double side = random.magnitude(-30, 30);
        const double radius = side * random.magnitude(-9, 1);
        const double far = random.below(10) == 0 ? random.magnitude(0, 20) : 1;
        const Disc one{far * side * random.uniform(-1, 2), far * side * random.uniform(-1, 2), 0, 0};
        const double angle = random.uniform(0, 6.3);
        const double distance = 2 * radius * (random.coin() ? 1 : random.uniform(0, 2));
        const Disc two{one.x + distance * std::cos(angle), one.y + distance * std::sin(angle), 0, 0};
        const std::vector<float> x{filter_position(two.x, 1 / side), 0, 0, 0};
        const std::vector<float> y{filter_position(two.y, 1 / side), 0, 0, 0};
        const unsigned kept =
            may_overlap(x.data(), y.data(), filter_position(one.x, 1 / side),
                        filter_position(one.y, 1 / side), filter_reach_squared(side, radius), 1);
        if (overlap(one, two, 4 * radius * radius)) {
            ASSERT_EQ(kept & 1U, 1U) << one << " and " << two << ", L = " << side << ", r = " << radius;
        }
        ASSERT_EQ(kept >> 1U, 0U);
        dropped += kept == 0;
    }
    EXPECT_GT(dropped, 10'000) << "a filter that drops nothing is none";
}

TEST(FourAtOnce, KnowsEverySet) {
    for (unsigned set = 0; set < 16; ++set) {
        FourInts truths{};
        std::vector<int> members;
        for (int disc = 0; disc < 4; ++disc) {
            if ((set >> disc & 1U) != 0) {
                truths[disc] = -1;
                members.push_back(disc);
            }
        }
        EXPECT_EQ(to_bitmask_portably(truths), set);
        EXPECT_EQ(to_bitmask(truths), set);
        ASSERT_EQ(compress_table.count[set], std::ssize(members));
        for (std::size_t k = 0; k < members.size(); ++k) {
            EXPECT_EQ(compressed_indices(7, set)[k], 7 + members[k]);
        }
    }
}

} // namespace
} // namespace carom
