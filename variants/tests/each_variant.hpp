#pragma once

#include <algorithm>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "variants/registry.hpp"

namespace carom {

inline void PrintTo(const Variant& variant, std::ostream* stream) { *stream << variant.name; }

} // namespace carom

namespace carom::tests {

/// The variant's name as part of a test's.
inline std::string variant_test_name(const testing::TestParamInfo<Variant>& variant) {
    std::string name(variant.param.name);
    std::ranges::replace(name, '-', '_');
    return name;
}

} // namespace carom::tests
