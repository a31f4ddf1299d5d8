// A program of its own: it counts what every `new` of the process asks for.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <string>

#include <gtest/gtest.h>

#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "kernels/tests/scenes.hpp"

namespace {

std::atomic<std::size_t> allocations = 0;
std::atomic<std::size_t> largest_allocation = 0;

void* count_and_allocate(std::size_t size, std::size_t alignment) {
    ++allocations;
    largest_allocation = std::max(largest_allocation.load(), size);
    void* memory = nullptr;
    if (posix_memalign(&memory, std::max(alignment, sizeof(void*)), size) != 0) {
        throw std::bad_alloc();
    }
    return memory;
}

} // namespace

void* operator new(std::size_t size) { return count_and_allocate(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return count_and_allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace carom {
namespace {

struct Memory {
    std::size_t allocations;
    std::size_t largest;
};

/// What parsing the text asks for, accepted or not.
Memory asked_for_by(const std::string& text, bool accepted) {
    allocations = 0;
    largest_allocation = 0;
    bool was_accepted = true;
    try {
        parse_scene(text, "scene.in");
    } catch (const InputError&) {
        was_accepted = false;
    }
    const Memory memory{allocations, largest_allocation};
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
