#include <string>

#include <gtest/gtest.h>

#include "harness/scenes/hard_cases.hpp"

namespace carom {
namespace {

TEST(HardCaseList, HasEveryCaseOnce) {
    std::string names;
    for (const auto& one : hard_cases()) {
        names.append(names.empty() ? "" : " ").append(one.name);
        EXPECT_EQ(find_hard_case(one.name), &one);
        EXPECT_FALSE(one.description.empty());
    }
    EXPECT_EQ(names, "cradle corner pinned rack_break three_body coincident nearly_coincident grazing jammed "
                     "hexagonal fast at_rest one_disc no_discs scaled_down scaled_up far_coordinates drift "
                     "reversed renumbered mirrored rotated");
    EXPECT_EQ(find_hard_case("no such case"), nullptr);
}

} // namespace
} // namespace carom
