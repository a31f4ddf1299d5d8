#include <algorithm>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "harness/verify/checker.hpp"
#include "kernels/find.hpp"
#include "kernels/step.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

/// The four boxes but for one: no disc looks across the edge between the boxes 0 and 1 of an axis.
constexpr auto broken = static_cast<Neighbourhood>(99);

} // namespace

template <> struct Look<broken> {
    static BoxRange along(const Grid& grid, double position, int index) {
        BoxRange range = Look<Neighbourhood::four>::along(grid, position, index);
        if (index == 0) {
            range.last = 0;
        } else if (index == 1) {
            range.first = 1;
        }
        return range;
    }
};

namespace {

template <Policies policies> std::optional<std::string> first_violation(const Scene& scene) {
    State<policies> state(scene);
    NoProbe probe;
    const Checker checker(scene.side, scene.radius, 1, Tolerance::relative);
    for (int k = 0; k < scene.steps; ++k) {
        const std::vector<Disc> before = state.discs;
        step<policies>(state, {}, probe);
        if (auto violation = checker.step(before, state.discs)) {
            return violation;
        }
    }
    return std::nullopt;
}

Scene scene(std::uint64_t seed) { return tests::random_scene(300, 60, 1, 10, 1, seed); }

template <Order order> void is_caught() {
    for (std::uint64_t seed = 111; seed < 116; ++seed) {
        const auto violation =
            first_violation<Policies{.neighbourhood = broken, .order = order}>(scene(seed));
        ASSERT_NE(violation, std::nullopt) << "seed " << seed;
        EXPECT_PRED_FORMAT2(testing::IsSubstring, "are left approaching at", *violation);
    }
}

TEST(BrokenVariant, IsCaughtInTheCheckeredOrder) { is_caught<Order::checkered>(); }
TEST(BrokenVariant, IsCaughtInTheRowOrder) { is_caught<Order::row>(); }
TEST(BrokenVariant, IsCaughtInASequentialOrder) { is_caught<Order::track>(); }

TEST(BrokenVariant, IsBrokenByTheMissingBoxAlone) {
    for (std::uint64_t seed = 111; seed < 116; ++seed) {
        EXPECT_EQ(first_violation<Policies{}>(scene(seed)), std::nullopt) << "seed " << seed;
    }
}

TEST(BrokenVariant, IsCaughtByASinglePairAcrossTheMissingEdge) {
    const Scene pair{.side = 50, .radius = 1, .steps = 1, .discs = {{4, 22, 0.5, 0}, {6, 22, 0, 0}}};
    EXPECT_EQ(first_violation<Policies{.neighbourhood = broken}>(pair),
              "discs 0 and 1, 1.5 apart, are left approaching at 0.5 per unit of time");
    EXPECT_EQ(first_violation<Policies{}>(pair), std::nullopt);
}

} // namespace
} // namespace carom
