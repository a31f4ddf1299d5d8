#include <algorithm>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/energy_drift.hpp"
#include "harness/scenes/changed_scenes.hpp"
#include "harness/tests/verify/hard_cases.hpp"
#include "harness/verify/overlapping_pairs.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/tests/each_variant.hpp"

namespace carom {
namespace {

using tests::checked_run;
using tests::same_bits;
using tests::scene_of;

/// Is no disc ever in contact with more than one other disc or wall at the end of a step? Then a step has
/// nothing to choose: the order in which discs, boxes and overlaps come up does not matter, nor does the box
/// side. (At contact no two discs of this scene are left overlapping, and the order is that of time.)
testing::AssertionResult has_single_contacts(const Variant& variant, const Scene& scene,
                                             const Tuning& tuning) {
    std::vector<int> contacts;
    int most = 0;
    int pairs_met = 0;
    const auto simulation = variant.simulate(scene, tuning);
    for (int step = 0; step < scene.steps * tuning.substeps; ++step) {
        const Tally tally = simulation->step();
        pairs_met += static_cast<int>(tally.pair_resolves);
        const std::vector<Disc>& discs = simulation->discs();
        contacts.assign(discs.size(), 0);
        for (const OverlappingPair& pair : overlapping_pairs(discs, scene.radius)) {
            ++contacts[static_cast<std::size_t>(pair.first)];
            ++contacts[static_cast<std::size_t>(pair.second)];
        }
        for (std::size_t i = 0; i < discs.size(); ++i) {
            const auto at_wall = [&scene](double position) {
                return position <= scene.radius * (1 + 1e-6) ||
                       position >= scene.side - scene.radius * (1 + 1e-6);
            };
            // Both walls of a corner turn in the same visit.
            contacts[i] += at_wall(discs[i].x) || at_wall(discs[i].y);
            most = std::max(most, contacts[i]);
        }
    }
    if (most > 1) {
        return testing::AssertionFailure() << "a disc has " << most << " contacts";
    }
    if (pairs_met < 20) {
        return testing::AssertionFailure() << "only " << pairs_met << " pairs met";
    }
    return testing::AssertionSuccess();
}

class ChangedScene : public testing::TestWithParam<Variant> {
  protected:
    static constexpr Tuning tunings[] = {{.substeps = 1}, {.substeps = 4}};

    static std::vector<Disc> end_of(const Scene& scene, const Tuning& tuning) {
        return checked_run(GetParam(), scene, tuning).discs;
    }

    /// The end of the plain scene, changed, is the end of the changed one, to the last bit.
    template <class Change> static void ends_likewise(std::string_view name, const Change& change) {
        for (const Tuning& tuning : tunings) {
            Scene plain = plain_scene();
            ASSERT_TRUE(has_single_contacts(GetParam(), plain, tuning));
            plain.discs = end_of(plain, tuning);
            EXPECT_TRUE(same_bits(end_of(scene_of(name), tuning), change(plain).discs))
                << tuning.substeps << " substeps";
        }
    }
};

TEST_P(ChangedScene, ScaledDownDoesTheSame) {
    ends_likewise("scaled_down", [](const Scene& scene) { return scaled(scene, 0x1p-20); });
}

TEST_P(ChangedScene, ScaledUpDoesTheSame) {
    ends_likewise("scaled_up", [](const Scene& scene) { return scaled(scene, 0x1p20); });
}

TEST_P(ChangedScene, RenumberedDoesTheSame) { ends_likewise("renumbered", renumbered); }

/// Sums of x and y terms have two terms each, so that exchanging them changes no bit.
TEST_P(ChangedScene, MirroredDoesTheSame) { ends_likewise("mirrored", mirrored); }

/// L - y is not rounded as y is: the two runs part at the level of rounding, which each collision multiplies
/// by about the free path over the radius, some 20 here, and each disc has about two.
TEST_P(ChangedScene, RotatedDoesTheSameButForRounding) {
    const double allowed = 64 * 20 * 20 * 20 * rounding_of(GetParam().policies).epsilon();
    for (const Tuning& tuning : tunings) {
        Scene plain = plain_scene();
        plain.discs = end_of(plain, tuning);
        EXPECT_LT(tests::largest_distance(end_of(scene_of("rotated"), tuning), rotated(plain).discs), allowed)
            << tuning.substeps << " substeps";
    }
}

/// Where discs meet several at a time the order matters, and the published box side, 4r + 1, makes it depend
/// on the unit of length. What holds with it is: the same moves, the same overlaps in the first step, the
/// same tolerance, so that as much energy is kept and the checker has nothing to say.
TEST_P(ChangedScene, CrowdedAndScaledFindsTheSameOverlapsAtFirst) {
    const Scene crowded = tests::random_scene_of_density(300, 0.9, 10, 4);
    for (const double factor : {0x1p-20, 0x1p20}) {
        const Scene changed = scaled(crowded, factor);
        const auto simulation = GetParam().simulate(crowded, {});
        const auto scaled_simulation = GetParam().simulate(changed, {});
        EXPECT_EQ(scaled_simulation->step().overlaps, simulation->step().overlaps);
        for (std::size_t i = 0; i < crowded.discs.size(); ++i) {
            EXPECT_EQ(scaled_simulation->discs()[i].x, simulation->discs()[i].x * factor);
            EXPECT_EQ(scaled_simulation->discs()[i].y, simulation->discs()[i].y * factor);
        }
        const double epsilon = rounding_of(GetParam().policies).epsilon();
        EXPECT_NEAR(energy_drift(changed, end_of(changed, {})).value(), 0, 1e3 * epsilon);
    }
}

TEST_P(ChangedScene, CrowdedAndScaledDoesTheSameInSnugBoxes) {
    if (GetParam().policies.box_side != BoxSide::snug) {
        GTEST_SKIP() << "a wide box has one unit of length added";
    }
    const Scene crowded = tests::random_scene_of_density(300, 0.9, 10, 4);
    for (const double factor : {0x1p-20, 0x1p20}) {
        Scene end = crowded;
        end.discs = end_of(crowded, {});
        EXPECT_TRUE(same_bits(end_of(scaled(crowded, factor), {}), scaled(end, factor).discs)) << factor;
    }
}

INSTANTIATE_TEST_SUITE_P(Registry, ChangedScene, testing::ValuesIn(variants().begin(), variants().end()),
                         tests::variant_test_name);

TEST(ChangedSceneItself, IsUndoneByItsInverse) {
    const Scene scene = plain_scene();
    EXPECT_TRUE(same_bits(scaled(scaled(scene, 0x1p-20), 0x1p20).discs, scene.discs));
    EXPECT_TRUE(same_bits(renumbered(renumbered(scene)).discs, scene.discs));
    EXPECT_TRUE(same_bits(mirrored(mirrored(scene)).discs, scene.discs));
    EXPECT_TRUE(same_bits(rotated(rotated(rotated(rotated(scene)))).discs, scene.discs));
    EXPECT_TRUE(same_bits(turned_back(turned_back(scene)).discs, scene.discs));
    EXPECT_FALSE(same_bits(rotated(scene).discs, mirrored(scene).discs));
}

} // namespace
} // namespace carom
