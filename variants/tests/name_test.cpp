#include <string>

#include <gtest/gtest.h>

#include "variants/name.hpp"

namespace carom {
namespace {

std::string name(const Policies& policies) { return std::string(name_of(policies).view()); }

TEST(NameOf, SaysOnlyWhatDiffersFromThePublishedBest) {
    EXPECT_EQ(name({.neighbourhood = Neighbourhood::nine}), "nine");
    EXPECT_EQ(name({.order = Order::row}), "row");
    EXPECT_EQ(name({.self_contained = SelfContained::off}), "self_contained_off");
    EXPECT_EQ(name({.direction = Direction::forward}), "forward");
    EXPECT_EQ(name({.find_schedule = Schedule::static_}), "find_static");
    EXPECT_EQ(name({.find_schedule = Schedule::guided}), "find_guided");
    EXPECT_EQ(name({.resolve_schedule = Schedule::dynamic_chunk}), "resolve_dynamic_chunk");
    EXPECT_EQ(name({.order = Order::row, .resolve_schedule = Schedule::dynamic}), "row-resolve_dynamic");
}

TEST(NameOf, NamesPoliciesInTheirOrder) {
    EXPECT_EQ(name({.neighbourhood = Neighbourhood::nine,
                    .order = Order::row,
                    .self_contained = SelfContained::off,
                    .direction = Direction::forward,
                    .find_schedule = Schedule::dynamic_chunk,
                    .resolve_schedule = Schedule::dynamic_chunk}),
              "nine-row-self_contained_off-forward-find_dynamic_chunk-resolve_dynamic_chunk");
}

} // namespace
} // namespace carom
