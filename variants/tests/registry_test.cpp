#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/tests/scenes.hpp"
#include "kernels/tests/simulate.hpp"
#include "variants/event_driven_variant.hpp"
#include "variants/name.hpp"
#include "variants/registry.hpp"
#include "variants/table.hpp"
#include "variants/tests/each_variant.hpp"

namespace carom {
namespace {

using tests::same_bits;

TEST(Registry, HasOneVariantForEachRowOfTheTable) {
    ASSERT_EQ(variants().size(), table.size());
    for (std::size_t row = 0; row < table.size(); ++row) {
        EXPECT_EQ(variants()[row].policies, table[row]);
        EXPECT_EQ(variants()[row].name, name_of(table[row]).view());
    }
}

TEST(FindVariant, FindsEachByItsNameWhichAShellTakesAsItIs) {
    for (const Variant& variant : variants()) {
        EXPECT_EQ(find_variant(variant.name), &variant) << variant.name;
        EXPECT_EQ(variant.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_-"), std::string_view::npos);
    }
}

TEST(FindVariant, FindsNothingElse) {
    for (const char* name :
         {"", "Published", "published ", "checkered", "four", "row-", "row_resolve_dynamic"}) {
        EXPECT_EQ(find_variant(name), nullptr) << name;
    }
}

TEST(EventDrivenVariant, IsFoundByItsNameAndStandsBesideTheTable) {
    EXPECT_EQ(event_driven().name, "event_driven");
    EXPECT_EQ(find_variant("event_driven"), &event_driven());
    EXPECT_EQ(event_driven().engine, Engine::event_driven);
    for (const Variant& variant : variants()) {
        EXPECT_EQ(variant.engine, Engine::steps);
    }
}

/// Adds up what it is told.
class Counter final : public Probe {
  public:
    void phase_begin(Phase) override { ++phases; }
    void sweep_begin() override { ++sweeps; }

    int phases = 0;
    int sweeps = 0;
};

class EveryVariant : public testing::TestWithParam<Variant> {};

struct End {
    std::vector<Disc> discs;
    Tally work;
};

End end_of(Simulation& simulation, int steps) {
    Tally work;
    for (int step = 0; step < steps; ++step) {
        work += simulation.step();
    }
    return {simulation.discs(), work};
}

End run(const Variant& variant, const Scene& scene) {
    return end_of(*variant.simulate(scene, {}), scene.steps);
}

TEST_P(EveryVariant, EndsInTheSameBitsUnderObservation) {
    const Scene scene = tests::random_scene(200, 60, 1, 10, 3, 92);
    Counter counter;
    const auto observed = GetParam().simulate_observed(scene, {}, counter);
    const End found = end_of(*observed, scene.steps);
    const End expected = run(GetParam(), scene);
    EXPECT_TRUE(same_bits(found.discs, expected.discs));
    EXPECT_EQ(found.work, expected.work);
    EXPECT_EQ(counter.sweeps, expected.work.sweeps);
    EXPECT_EQ(counter.phases, 4 * scene.steps);
}

TEST_P(EveryVariant, RunsTheSimulationOfItsOwnPolicies) {
    // Head-on, the pair settles in one visit: how many sweeps and resolves it takes tells the order,
    // self-contained and the impact. Taking it back to its contact takes two sweeps before the others.
    const Scene scene{.side = 50, .radius = 1, .steps = 1, .discs = {{21, 22, 1, 0}, {23.5, 22, 0, 0}}};
    Tally work = run(GetParam(), scene).work;
    EXPECT_GE(work.pair_attempts, 2);
    work.pair_attempts = 0;
    const Policies& policies = GetParam().policies;
    const bool done_in_one = policies.self_contained == SelfContained::on || policies.order == Order::track;
    const int sweeps = policies.impact == Impact::at_contact ? 2 + 1 : (done_in_one ? 1 : 2);
    EXPECT_EQ(work, (Tally{.overlaps = 1, .pair_resolves = 1, .sweeps = sweeps}));
}

/// Runs to the end from the start, again and again on the same simulation: after a whole run, after one
/// broken off at an odd step, at once, and after both have been looked at.
void restarts_in_the_same_bits(const Variant& variant, const Scene& scene, const Tuning& tuning) {
    const End expected = end_of(*variant.simulate(scene, tuning), scene.steps);
    ASSERT_FALSE(same_bits(expected.discs, scene.discs));
    const auto simulation = variant.simulate(scene, tuning);
    for (const int steps_before : {scene.steps, 3, 0, 1}) {
        SCOPED_TRACE(testing::Message() << "after " << steps_before << " steps");
        end_of(*simulation, steps_before);
        simulation->restart(scene);
        EXPECT_TRUE(same_bits(simulation->discs(), variant.simulate(scene, tuning)->discs()));
        const End found = end_of(*simulation, scene.steps);
        EXPECT_TRUE(same_bits(found.discs, expected.discs));
        EXPECT_EQ(found.work, expected.work);
        simulation->restart(scene);
    }
}

TEST_P(EveryVariant, RestartsInTheSameBits) {
    const Scene dense = tests::random_scene_of_density(300, 0.9, 6, 93);
    restarts_in_the_same_bits(GetParam(), dense, {});
    restarts_in_the_same_bits(GetParam(), dense, {.threads = 3, .substeps = 2});
    restarts_in_the_same_bits(GetParam(), tests::random_scene(200, 60, 1, 10, 3, 94), {.threads = 2});
}

TEST(EventDrivenVariant, RestartsInTheSameBits) {
    restarts_in_the_same_bits(event_driven(), tests::cradle(), {});
    // So many that the queue of events begins several years.
    restarts_in_the_same_bits(event_driven(), tests::random_scene_of_density(3000, 0.5, 20, 95), {});
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryVariant, testing::ValuesIn(variants().begin(), variants().end()),
                         tests::variant_test_name);

} // namespace
} // namespace carom
