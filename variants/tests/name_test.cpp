#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "variants/name.hpp"

namespace carom {
namespace {

std::string name(const Policies& policies) { return std::string(name_of(policies).view()); }

TEST(Word, IsTheDesignsWhereNoNameHasIt) {
    EXPECT_EQ(word(Neighbourhood::four), "four");
    EXPECT_EQ(word(Order::checkered), "checkered");
    EXPECT_EQ(word(SelfContained::on), "on");
    EXPECT_EQ(word(Direction::reverse), "reverse");
    EXPECT_EQ(word(Schedule::guided_chunk), "guided_chunk");
    EXPECT_EQ(word(Storage::numbered), "numbered");
    EXPECT_EQ(word(Prefetch::off), "off");
    EXPECT_EQ(word(BoxSide::wide), "wide");
    EXPECT_EQ(word(Overlaps::lists), "lists");
    EXPECT_EQ(word(Search::exact), "exact");
    EXPECT_EQ(word(Worklist::all), "all");
    EXPECT_EQ(word(Impact::step_end), "step_end");
    EXPECT_EQ(word(Precision::double_), "double");
}

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

const std::vector<Schedule> every_schedule{Schedule::static_, Schedule::static_chunk,
                                           Schedule::dynamic, Schedule::dynamic_chunk,
                                           Schedule::guided,  Schedule::guided_chunk};

std::vector<Policies> every_combination() {
    std::vector<Policies> combinations;
    for (const auto neighbourhood : {Neighbourhood::nine, Neighbourhood::four}) {
        for (const auto order : {Order::checkered, Order::row, Order::track, Order::repeat, Order::once}) {
            for (const auto self_contained : {SelfContained::on, SelfContained::off}) {
                for (const auto direction : {Direction::reverse, Direction::forward}) {
                    for (const auto find_schedule : every_schedule) {
                        for (const auto resolve_schedule : every_schedule) {
                            combinations.push_back({neighbourhood, order, self_contained, direction,
                                                    find_schedule, resolve_schedule});
                        }
                    }
                }
            }
        }
    }
    return combinations;
}

TEST(NameOf, IsDifferentForEveryCombinationAndTakenByFilesAndShellsAsItIs) {
    std::set<std::string> names;
    for (const Policies& policies : every_combination()) {
        EXPECT_TRUE(names.insert(name(policies)).second) << name(policies);
        EXPECT_EQ(name(policies).find_first_not_of("abcdefghijklmnopqrstuvwxyz_-"), std::string::npos);
    }
    EXPECT_EQ(names.size(), 2u * 5 * 2 * 2 * 6 * 6);
}

} // namespace
} // namespace carom
