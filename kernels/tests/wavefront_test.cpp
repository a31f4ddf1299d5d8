#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

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

TEST(SweepOrder, AreSweepBySweepIfAllPairsAreAtOnce) {
    int last = 0;
    for (const auto [strip, sweep] : sweep_order(9, 4, 9)) {
        const int place = 2 * sweep + strip % 2;
        EXPECT_GE(place, last);
        last = place;
    }
    EXPECT_EQ(last, 7);
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

constexpr Policies active(Order order, Overlaps overlaps, Precision precision) {
    return {.order = order,
            .self_contained = SelfContained::off,
            .resolve_schedule = Schedule::dynamic,
            .storage = Storage::sorted,
            .overlaps = overlaps,
            .worklist = overlaps == Overlaps::contacts ? Worklist::active : Worklist::all,
            .precision = precision};
}

/// A scene that is said to exceed the cache against `strips`, one sweep after the other.
template <Precision precision> void skewed_does_the_same() {
    constexpr auto contacts = Overlaps::contacts;
    const Scene scene = tests::random_scene_of_density(3000, 0.9, 4, 82);
    const Outcome expected = simulate<active(Order::strips, contacts, precision)>(scene, {.threads = 1});
    ASSERT_GT(expected.work.sweeps, scene.steps * most_sweeps_at_once);
    for (const int threads : {1, 2, 3, 8}) {
        for (const std::size_t cache_bytes : {std::size_t{0}, Tuning{}.cache_bytes}) {
            const Outcome found = simulate<active(Order::wavefront, contacts, precision)>(
                scene, {.threads = threads, .cache_bytes = cache_bytes});
            EXPECT_TRUE(same_bits(found.discs, expected.discs)) << threads << ", " << cache_bytes;
            EXPECT_EQ(found.work, expected.work) << threads << ", " << cache_bytes;
        }
    }
}

TEST(SkewedSweeps, EndInTheSameBitsAfterTheSameWork) { skewed_does_the_same<Precision::double_>(); }

TEST(SkewedSweeps, EndInTheSameBitsAfterTheSameWorkInFloat) { skewed_does_the_same<Precision::float_>(); }

TEST(SkewedSweeps, EndAtTheSweepLimit) {
    const Scene scene = tests::random_scene_of_density(3000, 0.9, 4, 82);
    for (const int limit : {1, 2, 5, 8, 9, 13}) {
        const auto limited = [&](std::size_t cache_bytes) {
            return simulate<active(Order::wavefront, Overlaps::contacts, Precision::double_)>(
                scene, {.cache_bytes = cache_bytes, .sweep_limit = limit});
        };
        const Outcome expected = limited(Tuning{}.cache_bytes);
        const Outcome found = limited(0);
        EXPECT_FALSE(expected.work.settled);
        EXPECT_TRUE(same_bits(found.discs, expected.discs)) << limit;
        EXPECT_EQ(found.work, expected.work) << limit;
    }
}

TEST(SkewedSweeps, AreForContactsOfWhichSomeAreActive) {
    const Scene scene = tests::random_scene_of_density(700, 0.9, 1, 83);
    constexpr auto contacts = active(Order::wavefront, Overlaps::contacts, Precision::double_);
    constexpr auto lists = active(Order::wavefront, Overlaps::lists, Precision::double_);
    State<contacts> of_contacts(scene);
    EXPECT_TRUE(exceeds_cache(of_contacts, {.cache_bytes = 0}));
    EXPECT_FALSE(exceeds_cache(of_contacts, {}));
    State<lists> of_lists(scene);
    EXPECT_FALSE(exceeds_cache(of_lists, {.cache_bytes = 0}));
}

} // namespace
} // namespace carom
