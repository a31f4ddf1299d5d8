#include <cstdint>
#include <fstream>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/measure.hpp"
#include "harness/scenes/generate.hpp"
#include "variants/registry.hpp"

// What the published program and its variants end in: the FNV-1a hash of the bits of all discs and the number
// of pair resolves, as they were read off those programs (built without contraction, on 1 and on 2 threads).
// They stand in published_states.txt: variant, scene, steps, pair resolves, hash.

namespace carom {
namespace {

struct PublishedState {
    std::string variant;
    std::string scene;
    int steps = 0;
    std::int64_t pair_resolves = 0;
    std::string hash;
};

void PrintTo(const PublishedState& state, std::ostream* stream) {
    *stream << state.variant << " on " << state.scene << " after " << state.steps << " steps";
}

/// Those of the file. Asking for memory ahead must not change those of `published`.
std::vector<PublishedState> published_states() {
    std::vector<PublishedState> states;
    std::ifstream file(CAROM_PUBLISHED_STATES);
    for (PublishedState one;
         file >> one.variant >> one.scene >> one.steps >> one.pair_resolves >> one.hash;) {
        states.push_back(one);
        if (one.variant == "published") {
            one.variant = "prefetch_on";
            states.push_back(one);
        }
    }
    return states;
}

GeneratorArguments arguments_of(const PublishedState& state) {
    const std::map<std::string, GeneratorArguments> scenes{
        {"dense", {2000, 1414, 16, state.steps, 2, 5, 1}},
        {"sparse", {5000, 10000, 16, state.steps, 2, 5, 1}},
        {"large_discs", {1000, 3162, 50, state.steps, 2, 5, 1}}};
    return scenes.at(state.scene);
}

class EndsInPublishedState : public testing::TestWithParam<PublishedState> {};

TEST_P(EndsInPublishedState, OnAnyNumberOfThreads) {
    const PublishedState& expected = GetParam();
    const Scene scene = generate(arguments_of(expected));
    const Variant* const variant = find_variant(expected.variant);
    ASSERT_NE(variant, nullptr);
    for (const int threads : {1, 2, 3, 8}) {
        SCOPED_TRACE(testing::Message() << threads << " threads");
        const Tuning tuning{.threads = threads, .tolerance = Tolerance::published};
        const auto simulation = variant->simulate(scene, tuning);
        const carom::Run run = run_scene(scene, *simulation, tuning, CheckScope::nothing);
        EXPECT_EQ(state_hash(run.discs), expected.hash);
        EXPECT_EQ(run.work.pair_resolves, expected.pair_resolves);
    }
}

INSTANTIATE_TEST_SUITE_P(Programs, EndsInPublishedState, testing::ValuesIn(published_states()));

TEST(PublishedStates, AreAllThere) { EXPECT_EQ(published_states().size(), 63U + 7U); }

/// The published tolerance is not the default: what is told of `published` to the last bit is told under it.
TEST(PublishedTolerance, IsNotTheDefault) { EXPECT_EQ(Tuning{}.tolerance, Tolerance::relative); }

} // namespace
} // namespace carom
