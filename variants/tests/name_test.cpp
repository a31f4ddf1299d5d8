#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "variants/name.hpp"

namespace carom {
namespace {

std::string name(const Policies& policies) { return std::string(name_of(policies).view()); }

TEST(Word, IsTheDesignsForEveryPolicyValue) {
    EXPECT_EQ(word(Neighbourhood::nine), "nine");
    EXPECT_EQ(word(Neighbourhood::four), "four");
    EXPECT_EQ(word(Order::checkered), "checkered");
    EXPECT_EQ(word(Order::row), "row");
    EXPECT_EQ(word(Order::track), "track");
    EXPECT_EQ(word(Order::repeat), "repeat");
    EXPECT_EQ(word(Order::once), "once");
    EXPECT_EQ(word(Order::strips), "strips");
    EXPECT_EQ(word(Order::wavefront), "wavefront");
    EXPECT_EQ(word(Storage::numbered), "numbered");
    EXPECT_EQ(word(Storage::sorted), "sorted");
    EXPECT_EQ(word(BoxSide::wide), "wide");
    EXPECT_EQ(word(BoxSide::snug), "snug");
    EXPECT_EQ(word(Overlaps::lists), "lists");
    EXPECT_EQ(word(Overlaps::contacts), "contacts");
    EXPECT_EQ(word(Search::exact), "exact");
    EXPECT_EQ(word(Search::filtered), "filtered");
    EXPECT_EQ(word(Worklist::all), "all");
    EXPECT_EQ(word(Worklist::active), "active");
    EXPECT_EQ(word(Precision::double_), "double");
    EXPECT_EQ(word(Precision::float_), "float");
    EXPECT_EQ(word(SelfContained::on), "on");
    EXPECT_EQ(word(SelfContained::off), "off");
    EXPECT_EQ(word(Direction::reverse), "reverse");
    EXPECT_EQ(word(Direction::forward), "forward");
    EXPECT_EQ(word(Schedule::static_), "static");
    EXPECT_EQ(word(Schedule::static_chunk), "static_chunk");
    EXPECT_EQ(word(Schedule::dynamic), "dynamic");
    EXPECT_EQ(word(Schedule::dynamic_chunk), "dynamic_chunk");
    EXPECT_EQ(word(Schedule::guided), "guided");
    EXPECT_EQ(word(Schedule::guided_chunk), "guided_chunk");
}

TEST(NameOf, IsPublishedForTheDefaults) { EXPECT_EQ(name({}), "published"); }

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

TEST(NameOf, IsKnownWhenCompiling) {
    static_assert(name_of({.order = Order::track}).view() == "track");
    static_assert(name_of({}).view() == std::string_view("published"));
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

TEST(NameOf, IsDifferentForEveryCombination) {
    std::set<std::string> names;
    for (const Policies& policies : every_combination()) {
        EXPECT_TRUE(names.insert(name(policies)).second) << name(policies);
    }
    EXPECT_EQ(names.size(), 2u * 5 * 2 * 2 * 6 * 6);
}

TEST(NameOf, HoldsOnlyLettersThatFileNamesAndShellsTakeAsTheyAre) {
    for (const Policies& policies : every_combination()) {
        EXPECT_EQ(name(policies).find_first_not_of("abcdefghijklmnopqrstuvwxyz_-"), std::string::npos);
    }
}

} // namespace
} // namespace carom
