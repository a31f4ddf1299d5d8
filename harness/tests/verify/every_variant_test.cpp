#include <string>

#include <gtest/gtest.h>

#include "harness/measure/measure.hpp"
#include "kernels/tests/scenes.hpp"
#include "variants/registry.hpp"
#include "variants/tests/each_variant.hpp"

namespace carom {
namespace {

class CheckedVariant : public testing::TestWithParam<Variant> {
  protected:
    static std::string violation(const Scene& scene, const Tuning& tuning) {
        return checked_run(scene, GetParam(), tuning).violation.value_or("");
    }
};

TEST_P(CheckedVariant, PassesInEveryScene) {
    for (const auto& [name, scene] : tests::all_scenes()) {
        if (!holds(GetParam().policies, scene)) {
            continue;
        }
        EXPECT_EQ(violation(scene, {}), "") << name;
        EXPECT_EQ(violation(scene, {.threads = 3, .find_chunk = 1, .resolve_chunk = 1}), "")
            << name << ", 3 threads";
    }
}

TEST_P(CheckedVariant, PassesInStepsOfAFractionOfTime) {
    const Scene scene = tests::random_scene(200, 60, 1, 6, 3, 121);
    for (const int substeps : {2, 3, 10}) {
        EXPECT_EQ(violation(scene, {.substeps = substeps}), "") << substeps << " substeps";
    }
}

TEST_P(CheckedVariant, PassesUnderThePublishedTolerance) {
    const Tuning tuning{.tolerance = Tolerance::published};
    EXPECT_EQ(violation(tests::random_scene(200, 60, 1, 12, 3, 122), tuning), "");
    EXPECT_EQ(violation(tests::random_scene_of_density(300, 0.9, 10, 123), tuning), "");
    EXPECT_EQ(violation(tests::cradle(), tuning), "");
}

TEST_P(CheckedVariant, SaysWhereAResolveDoesNotEnd) {
    const Scene wedged{.side = 2, .radius = 1, .steps = 3, .discs = {{0.5, 1, 0.5, 0}}};
    const std::string message = violation(wedged, {.sweep_limit = 20});
    EXPECT_PRED_FORMAT2(testing::IsSubstring,
                        "step 1: the resolve did not end within 20 sweeps: disc 0 at (1, 1) "
                        "is left moving into a wall with velocity (",
                        message);
}

INSTANTIATE_TEST_SUITE_P(Registry, CheckedVariant, testing::ValuesIn(variants().begin(), variants().end()),
                         tests::variant_test_name);

} // namespace
} // namespace carom
