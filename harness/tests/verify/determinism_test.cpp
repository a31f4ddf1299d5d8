#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/measure.hpp"
#include "kernels/tests/scenes.hpp"
#include "variants/registry.hpp"
#include "variants/tests/each_variant.hpp"

namespace carom {
namespace {

/// So dense that most discs are in reach of several boxes, which many threads then share.
const Scene& dense() {
    static const Scene scene = tests::random_scene_of_density(500, 0.9, 4, 171);
    return scene;
}

Run run(const Variant& variant, const Tuning& tuning) {
    const auto simulation = variant.simulate(dense(), tuning);
    return run_scene(dense(), *simulation, tuning, CheckScope::nothing);
}

std::string final_hash(const Variant& variant, const Tuning& tuning) {
    return state_hash(run(variant, tuning).discs);
}

class PromisedVariant : public testing::TestWithParam<Variant> {};

TEST_P(PromisedVariant, EndsInOneStateOverThreadsAndChunks) {
    const carom::Run expected = run(GetParam(), {.threads = 1});
    ASSERT_GT(expected.work.pair_resolves, 400);
    for (const int threads : {1, 2, 3, 5, 8, 16}) {
        for (const int chunk : {1, 3, 100}) {
            SCOPED_TRACE(testing::Message() << threads << " threads, chunks of " << chunk);
            const carom::Run found =
                run(GetParam(), {.threads = threads, .find_chunk = chunk, .resolve_chunk = chunk});
            EXPECT_EQ(state_hash(found.discs), state_hash(expected.discs));
            EXPECT_EQ(found.work, expected.work);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Registry, PromisedVariant, testing::ValuesIn(variants().begin(), variants().end()),
                         tests::variant_test_name);

/// Equal for variants that differ in nothing but their schedules.
Policies without_schedules(Policies policies) {
    policies.find_schedule = Policies{}.find_schedule;
    policies.resolve_schedule = Policies{}.resolve_schedule;
    return policies;
}

TEST(PromisedVariants, EndInOneStateOverSchedules) {
    std::vector<std::pair<const Variant*, std::string>> firsts;
    int compared = 0;
    for (const Variant& variant : variants()) {
        const std::string found = final_hash(variant, {.threads = 3});
        const auto first = std::ranges::find_if(firsts, [&variant](const auto& other) {
            return without_schedules(other.first->policies) == without_schedules(variant.policies);
        });
        if (first == firsts.end()) {
            firsts.emplace_back(&variant, found);
            continue;
        }
        ++compared;
        EXPECT_EQ(found, first->second) << variant.name << " against " << first->first->name;
    }
    EXPECT_GT(compared, 10);
}

TEST(PromisedVariants, DoNotAllEndInTheSameState) {
    EXPECT_NE(final_hash(*find_variant("published"), {}), final_hash(*find_variant("track"), {}))
        << "orders differ: a hash that sees no difference shows nothing";
}

} // namespace
} // namespace carom
