#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>

#include "kernels/tests/scenes.hpp"
#include "variants/event_driven_variant.hpp"
#include "variants/least_memory.hpp"
#include "variants/registry.hpp"

namespace carom {
namespace {

std::int64_t allocated() {
    const auto info = mallinfo2();
    return static_cast<std::int64_t>(info.uordblks + info.hblkhd);
}

/// Without the copy at the end and what a thread takes.
std::int64_t least_of_state(const Variant& variant, const Scene& scene) {
    constexpr std::int64_t of_a_thread = 32 << 10;
    const auto discs = static_cast<std::int64_t>(scene.discs.size());
    const bool steps = variant.engine == Engine::steps;
    return least_memory(variant, scene, discs, 1) - discs * static_cast<std::int64_t>(sizeof(Disc)) -
           (steps ? of_a_thread : 0);
}

void expect_no_more_than_held(const Variant& variant, const Scene& scene) {
    const std::int64_t before = allocated();
    const auto simulation = variant.simulate(scene, {.threads = 1});
    simulation->step();
    const std::int64_t held = allocated() - before;
    if (allocated() == 0) {
        GTEST_SKIP() << "the allocator of this build does not tell";
    }
    EXPECT_LE(least_of_state(variant, scene), held) << variant.name;
    EXPECT_GE(5 * least_of_state(variant, scene), held) << variant.name;
}

TEST(LeastMemory, IsNoMoreThanASimulationHolds) {
    const Scene scene = tests::lattice_scene(200, 0.4, 31);
    for (const Variant& variant : variants()) {
        expect_no_more_than_held(variant, scene);
    }
    expect_no_more_than_held(event_driven(), scene);
}

TEST(LeastMemory, OfAHundredMillionDiscsAndThreadsIsCountedInMoreThanAnInt) {
    const Scene box{.side = 19'817, .radius = 1, .steps = 1, .discs = {}};
    constexpr std::int64_t gibibyte = 1 << 30;
    for (const Variant& variant : variants()) {
        const std::int64_t one = least_memory(variant, box, 100'000'000, 1);
        EXPECT_GT(one, 5 * gibibyte) << variant.name;
        EXPECT_LT(one, 40 * gibibyte) << variant.name;
        EXPECT_LT(least_memory(variant, box, 100'000'000, 1024), one + gibibyte) << variant.name;
    }
}

} // namespace
} // namespace carom
