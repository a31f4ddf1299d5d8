#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/energy_drift.hpp"
#include "harness/scenes/changed_scenes.hpp"
#include "harness/tests/verify/hard_cases.hpp"
#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/tests/each_variant.hpp"

namespace carom {
namespace {

using tests::checked_run;
using tests::same_bits;
using tests::scene_of;

class ChangedScene : public testing::TestWithParam<Variant> {
  protected:
    static constexpr Tuning tunings[] = {{.substeps = 1}, {.substeps = 4}};

    static std::vector<Disc> end_of(const Scene& scene, const Tuning& tuning) {
        return checked_run(GetParam(), scene, tuning).discs;
    }

    /// The end of the plain scene, changed, is the end of the changed one, to the last bit. No disc of it is
    /// ever in contact with more than one other or a wall at the end of a step: there is no order to choose.
    template <class Change> static void ends_likewise(std::string_view name, const Change& change) {
        for (const Tuning& tuning : tunings) {
            Scene plain = plain_scene();
            const carom::Run end = checked_run(GetParam(), plain, tuning);
            EXPECT_GE(end.work.pair_resolves, 20);
            plain.discs = end.discs;
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
