#include <gtest/gtest.h>

#include "variants/fastest.hpp"
#include "variants/table.hpp"

namespace carom {
namespace {

const Policies& fastest_of(std::size_t count) {
    Scene scene{.side = 1000, .radius = 1, .discs = {}};
    scene.discs.resize(count);
    return fastest_variant(scene).policies;
}

TEST(FastestVariant, OfAFewDiscsIsSequential) {
    for (const std::size_t count : {0U, 1U, 70U}) {
        EXPECT_TRUE(is_sequential(fastest_of(count).order)) << count;
    }
}

TEST(FastestVariant, OfMoreDiscsIsTheLastRungOfTheLadder) {
    for (const std::size_t count : {71U, 100'000U}) {
        EXPECT_EQ(fastest_of(count), ladder.back()) << count;
    }
}

} // namespace
} // namespace carom
