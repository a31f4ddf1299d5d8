#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/measure.hpp"
#include "harness/scenes/generate.hpp"
#include "variants/registry.hpp"

// What the published program and its variants end in: the FNV-1a hash of the bits of all discs and the number
// of pair resolves, as they were read off those programs (built without contraction, on 1 and on 2 threads).

namespace carom {
namespace {

/// The generated scenes; the number of steps is a row's own.
constexpr GeneratorArguments dense{2000, 1414, 16, 0, 2, 5, 1};
constexpr GeneratorArguments sparse{5000, 10000, 16, 0, 2, 5, 1};
constexpr GeneratorArguments large_discs{1000, 3162, 50, 0, 2, 5, 1};

struct PublishedState {
    std::string_view variant;
    GeneratorArguments scene;
    int steps;
    std::int64_t pair_resolves;
    std::string_view hash;
};

void PrintTo(const PublishedState& state, std::ostream* stream) {
    *stream << state.variant << " on " << state.scene.count << " discs after " << state.steps << " steps";
}

// clang-format off: a state a line
constexpr PublishedState published_states[] = {
    {"published", dense, 1, 3188, "f25492b806e1983d"},
    {"published", dense, 5, 7733, "d16f54b07bfd7779"},
    {"published", dense, 50, 263291, "5264228ef2378877"},
    {"published", sparse, 1, 201, "cfc9fdaf8fc7443e"},
    {"published", sparse, 20, 470, "1c0e557b7ad047a5"},
    {"published", large_discs, 1, 1839, "4a330e372ac83857"},
    {"published", large_discs, 30, 23057, "a8a57920a8f3eb3c"},
    {"nine", dense, 1, 3186, "8f0b3527506cd8af"},
    {"nine", dense, 5, 7662, "52c1bbeca7424595"},
    {"nine", dense, 50, 262083, "7b2b737e1422dbf2"},
    {"nine", sparse, 1, 201, "cfc9fdaf8fc7443e"},
    {"nine", sparse, 20, 470, "1c0e557b7ad047a5"},
    {"nine", large_discs, 1, 1842, "bc694641af4328ae"},
    {"nine", large_discs, 30, 23345, "c6a367c19aced3c4"},
    {"self_contained_off", dense, 1, 3058, "e1204f457315bb85"},
    {"self_contained_off", dense, 5, 7604, "929b2cc076a7ffd3"},
    {"self_contained_off", dense, 50, 296629, "31b82df842bb4f3c"},
    {"self_contained_off", sparse, 1, 201, "a00b434f52e7c360"},
    {"self_contained_off", sparse, 20, 471, "0dbd57e405e169d1"},
    {"self_contained_off", large_discs, 1, 1734, "57763cf0b0b240b9"},
    {"self_contained_off", large_discs, 30, 23556, "fcb4f0324db093e2"},
    {"track", dense, 1, 3203, "554ef3221dd633c8"},
    {"track", dense, 5, 7775, "8794d5af16ccdff3"},
    {"track", dense, 50, 253025, "416d2090c0476717"},
    {"track", sparse, 1, 201, "ead651774c509259"},
    {"track", sparse, 20, 470, "aedea99bbdf9568f"},
    {"track", large_discs, 1, 1806, "5411b589efe46b4a"},
    {"track", large_discs, 30, 21509, "24d325d1567303ed"},
    {"repeat", dense, 1, 3197, "c5eecdd39abba5fb"},
    {"repeat", dense, 5, 7802, "a62907ed09b30635"},
    {"repeat", dense, 50, 256341, "4f4012513bf0d3f4"},
    {"repeat", sparse, 1, 201, "ead651774c509259"},
    {"repeat", sparse, 20, 470, "aedea99bbdf9568f"},
    {"repeat", large_discs, 1, 1828, "bfed4030e416efaf"},
    {"repeat", large_discs, 30, 22424, "ce1212b00b862769"},
    {"once", dense, 1, 3167, "b629558d7d13712e"},
    {"once", dense, 5, 7893, "f63ed8c103194617"},
    {"once", dense, 50, 252674, "dc736a8d58f6f3f9"},
    {"once", sparse, 1, 201, "ead651774c509259"},
    {"once", sparse, 20, 470, "aedea99bbdf9568f"},
    {"once", large_discs, 1, 1815, "f0c0a7294e45092e"},
    {"once", large_discs, 30, 22215, "568a5577d243e373"},
    {"track-self_contained_off", dense, 1, 3075, "178db90aa2f2706e"},
    {"track-self_contained_off", dense, 5, 7448, "64076cb51de175b0"},
    {"track-self_contained_off", dense, 50, 292425, "758df84f410e3c7d"},
    {"track-self_contained_off", sparse, 1, 201, "78eb0593fdacc14e"},
    {"track-self_contained_off", sparse, 20, 471, "7c6079e0c4f55f92"},
    {"track-self_contained_off", large_discs, 1, 1717, "f224761b5c6ce038"},
    {"track-self_contained_off", large_discs, 30, 21663, "e3043138323f6572"},
    {"repeat-self_contained_off", dense, 1, 3077, "2e661df64a5fac03"},
    {"repeat-self_contained_off", dense, 5, 7753, "da525f595d7d3e7f"},
    {"repeat-self_contained_off", dense, 50, 255032, "e7ab169025193f1a"},
    {"repeat-self_contained_off", sparse, 1, 201, "78eb0593fdacc14e"},
    {"repeat-self_contained_off", sparse, 20, 471, "7c6079e0c4f55f92"},
    {"repeat-self_contained_off", large_discs, 1, 1736, "87d9cda25050d17d"},
    {"repeat-self_contained_off", large_discs, 30, 22245, "efdf2803d8301757"},
    {"row-resolve_dynamic", dense, 1, 3209, "21e0cefddf423660"},
    {"row-resolve_dynamic", dense, 5, 7530, "72ab54cbfb52c5c0"},
    {"row-resolve_dynamic", dense, 50, 233908, "d46065d4a8e0f890"},
    {"row-resolve_dynamic", sparse, 1, 199, "90e6ef52f93f6750"},
    {"row-resolve_dynamic", sparse, 20, 470, "c7f1ed64e3ebf9c1"},
    {"row-resolve_dynamic", large_discs, 1, 1820, "0f5135401b7d4b63"},
    {"row-resolve_dynamic", large_discs, 30, 22350, "bba6e4b884583520"},
};
// clang-format on

class EndsInPublishedState : public testing::TestWithParam<PublishedState> {};

TEST_P(EndsInPublishedState, OnAnyNumberOfThreads) {
    const PublishedState& expected = GetParam();
    GeneratorArguments arguments = expected.scene;
    arguments.steps = expected.steps;
    const Scene scene = generate(arguments);
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

INSTANTIATE_TEST_SUITE_P(Programs, EndsInPublishedState, testing::ValuesIn(published_states));

/// The states of `published`, which asking for memory ahead must not change.
std::vector<PublishedState> with_prefetch() {
    std::vector<PublishedState> states;
    for (PublishedState state : published_states) {
        if (state.variant == "published") {
            state.variant = "prefetch_on";
            states.push_back(state);
        }
    }
    return states;
}

INSTANTIATE_TEST_SUITE_P(Prefetch, EndsInPublishedState, testing::ValuesIn(with_prefetch()));

/// The published tolerance is not the default: what is told of `published` to the last bit is told under it.
TEST(PublishedTolerance, IsNotTheDefault) { EXPECT_EQ(Tuning{}.tolerance, Tolerance::relative); }

} // namespace
} // namespace carom
