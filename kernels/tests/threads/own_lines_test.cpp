#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/threads/own_lines.hpp"

namespace carom {
namespace {

/// The cache lines that a vector's memory reaches into.
template <class Vector> std::set<std::uintptr_t> lines_of(const Vector& vector) {
    std::set<std::uintptr_t> lines;
    const auto* const bytes = reinterpret_cast<const unsigned char*>(vector.data());
    for (std::size_t k = 0; k < vector.capacity() * sizeof vector.front(); ++k) {
        lines.insert(reinterpret_cast<std::uintptr_t>(bytes + k) / cache_line);
    }
    return lines;
}

template <class Vector> void share_no_line() {
    std::vector<Vector> vectors;
    for (std::size_t length = 1; length < 60; ++length) {
        vectors.emplace_back(length);
    }
    std::set<std::uintptr_t> all;
    for (const Vector& vector : vectors) {
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(vector.data()) % cache_line, 0u);
        for (const std::uintptr_t line : lines_of(vector)) {
            EXPECT_TRUE(all.insert(line).second) << "a line of two vectors";
        }
    }
}

TEST(OwnVector, SharesNoCacheLine) {
    share_no_line<OwnVector<char>>();
    share_no_line<OwnVector<int>>();
    share_no_line<OwnVector<double>>();
}

TEST(UntouchedVector, SharesNoCacheLine) { share_no_line<UntouchedVector<int>>(); }

TEST(OwnVector, HoldsZerosAndKeepsWhatItHasWhenItGrows) {
    OwnVector<int> vector(3);
    EXPECT_EQ(vector, (OwnVector<int>{0, 0, 0}));
    for (int i = 0; i < 1000; ++i) {
        vector.push_back(i);
    }
    EXPECT_EQ(vector[2], 0);
    EXPECT_EQ(vector[3], 0);
    EXPECT_EQ(vector.back(), 999);
}

TEST(OwnLines, RefusesMoreThanAnIndexHolds) {
    OwnLines<double> memory;
    EXPECT_THROW(memory.allocate(static_cast<std::size_t>(-1)), std::bad_alloc);
    EXPECT_THROW(memory.allocate(static_cast<std::size_t>(-1) / sizeof(double)), std::bad_alloc);
}

} // namespace
} // namespace carom
