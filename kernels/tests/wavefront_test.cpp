#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/tests/fast_policies.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"
#include "kernels/wavefront.hpp"

namespace carom {
namespace {

using tests::Outcome;
using tests::same_bits;
using tests::simulate;

TEST(SweepOrder, AreEachOnceAndAfterThoseThatTheyWaitFor) {
    for (const int strips : {1, 2, 3, 4, 5, 8, 13, 24, 31}) {
        for (const int sweeps : {1, 2, 3, 8}) {
            for (const int pairs_at_once : {1, 2, 3, 5, strips}) {
                SCOPED_TRACE(testing::Message() << strips << " strips, " << sweeps << " sweeps, "
                                                << pairs_at_once << " pairs at once");
                Wavefront wavefront(strips);
                std::set<std::pair<int, int>> taken;
                for (const auto [strip, sweep] : sweep_order(strips, sweeps, pairs_at_once)) {
                    ASSERT_TRUE(wavefront.can_begin(strip, sweep)) << strip << ", " << sweep;
                    wavefront.ends(strip, sweep);
                    EXPECT_TRUE(taken.emplace(strip, sweep).second);
                }
                EXPECT_EQ(taken.size(), static_cast<std::size_t>(strips) * static_cast<std::size_t>(sweeps));
            }
        }
    }
}

TEST(SweepOrder, ComeBackToAStripBeforeOthersAreFarOff) {
    constexpr int strips = 100;
    constexpr int sweeps = 8;
    int furthest = 0;
    std::vector<int> swept(strips);
    for (const auto [strip, sweep] : sweep_order(strips, sweeps, 1)) {
        swept[static_cast<std::size_t>(strip)] = sweep + 1;
        const auto first_not_done =
            std::find_if(swept.begin(), swept.end(), [](int n) { return n < sweeps; });
        furthest = std::max(furthest, strip - static_cast<int>(first_not_done - swept.begin()));
    }
    EXPECT_LE(furthest, 4 * sweeps);
}

TEST(SkewedSweeps, AreForWhatExceedsTheCache) {
    const State<tests::fastest> state(tests::random_scene_of_density(700, 0.9, 1, 83));
    EXPECT_TRUE(exceeds_cache(state, {.cache_bytes = 0}));
    EXPECT_FALSE(exceeds_cache(state, {}));
}

TEST(SkewedSweeps, EndAtTheSweepLimit) {
    const Scene scene = tests::random_scene_of_density(3000, 1.2, 3, 72);
    for (const int limit : {1, 2, 5, 8, 9, 13}) {
        const auto limited = [&](std::size_t cache_bytes) {
            return simulate<tests::fastest>(scene, {.cache_bytes = cache_bytes, .sweep_limit = limit});
        };
        const Outcome expected = limited(Tuning{}.cache_bytes);
        const Outcome found = limited(0);
        EXPECT_FALSE(expected.work.settled);
        EXPECT_TRUE(same_bits(found.discs, expected.discs)) << limit;
        EXPECT_EQ(found.work, expected.work) << limit;
    }
}

} // namespace
} // namespace carom
