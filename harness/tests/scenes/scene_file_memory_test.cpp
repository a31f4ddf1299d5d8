// A program of its own: it counts what every `new` of the process asks for.

#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "kernels/tests/counted_memory.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom {
namespace {

struct Memory {
    std::size_t allocations;
    std::size_t largest;
};

/// What parsing the text asks for, accepted or not.
Memory asked_for_by(const std::string& text, bool accepted) {
    tests::memory::allocations = 0;
    tests::memory::largest = 0;
    bool was_accepted = true;
    try {
        parse_scene(text, "scene.in");
    } catch (const InputError&) {
        was_accepted = false;
    }
    const Memory memory{tests::memory::allocations, tests::memory::largest};
    EXPECT_EQ(was_accepted, accepted);
    return memory;
}

TEST(ParseScene, AllocatesNothingForDiscsThatAreNotThere) {
    constexpr std::size_t little = 4096;
    const std::string header = "\n10\n1\n5\n";
    for (const char* count : {"100000000", "99999999", "100000001", "9223372036854775807", "10"}) {
        EXPECT_LT(asked_for_by(count + header + "0 5 5 0 0\n", false).largest, little) << count;
    }
}

TEST(ParseScene, AllocatesNothingForASceneWhoseHeaderIsWrong) {
    const std::string discs(1'000'000, ' ');
    EXPECT_LT(asked_for_by("100000\n1\n1\n5\n" + discs, false).largest, 4096u);
    EXPECT_LT(asked_for_by("100000\n10\n0\n5\n" + discs, false).largest, 4096u);
    EXPECT_LT(asked_for_by("100000\n10\n1\n-5\n" + discs, false).largest, 4096u);
}

TEST(ParseScene, AllocatesAsOftenForManyDiscsAsForFew) {
    const auto parse = [](int count) {
        return asked_for_by(scene_text(tests::random_scene(count, 1000, 1, 1, 5, 151)), true);
    };
    const Memory few = parse(100);
    const Memory many = parse(100'000);
    EXPECT_EQ(many.allocations, few.allocations);
    EXPECT_EQ(many.largest, 100'000 * sizeof(Disc));
}

} // namespace
} // namespace carom
