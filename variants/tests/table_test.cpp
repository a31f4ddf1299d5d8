#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "variants/name.hpp"
#include "variants/table.hpp"

namespace carom {
namespace {

constexpr Schedule schedules[]{Schedule::static_,       Schedule::static_chunk, Schedule::dynamic,
                               Schedule::dynamic_chunk, Schedule::guided,       Schedule::guided_chunk};
constexpr Order sequential_orders[]{Order::track, Order::repeat, Order::once};

testing::AssertionResult in_table(const Policies& policies) {
    if (std::ranges::find(table, policies) != table.end()) {
        return testing::AssertionSuccess();
    }
    return testing::AssertionFailure() << name_of(policies).view() << " is not in the table";
}

TEST(Table, HasEverySingleFlipOfThePublishedBest) {
    EXPECT_TRUE(in_table({.neighbourhood = Neighbourhood::nine}));
    EXPECT_TRUE(in_table({.order = Order::row}));
    EXPECT_TRUE(in_table({.order = Order::track}));
    EXPECT_TRUE(in_table({.order = Order::repeat}));
    EXPECT_TRUE(in_table({.order = Order::once}));
    EXPECT_TRUE(in_table({.self_contained = SelfContained::off}));
    EXPECT_TRUE(in_table({.direction = Direction::forward}));
    for (const Schedule schedule : schedules) {
        EXPECT_TRUE(in_table({.find_schedule = schedule}));
        EXPECT_TRUE(in_table({.resolve_schedule = schedule}));
    }
}

TEST(Table, HasWhatThePublishedGraphsCompare) {
    for (const Order order : sequential_orders) {
        EXPECT_TRUE(in_table({.order = order, .self_contained = SelfContained::on}));
        EXPECT_TRUE(in_table({.order = order, .self_contained = SelfContained::off}));
    }
    for (const Schedule schedule : schedules) {
        EXPECT_TRUE(in_table({.order = Order::row, .resolve_schedule = schedule}));
    }
    for (const Order order : {Order::checkered, Order::row, Order::track, Order::repeat, Order::once}) {
        EXPECT_TRUE(in_table({.order = order, .direction = Direction::forward}));
    }
}

TEST(Impossible, GivesAReasonForAScheduleWithoutALoopToSchedule) {
    for (const Order order : sequential_orders) {
        for (const Schedule schedule : schedules) {
            const std::string_view reason = impossible({.order = order, .resolve_schedule = schedule});
            if (schedule == Policies{}.resolve_schedule) {
                EXPECT_EQ(reason, "");
            } else {
                EXPECT_EQ(reason, "a sequential resolve order has no resolve schedule to choose");
            }
        }
    }
}

TEST(Impossible, GivesAReasonForContactsAndSnugBoxesWithoutWhatTheyNeed) {
    for (const Policies& policies :
         {Policies{.box_side = BoxSide::snug},
          Policies{.neighbourhood = Neighbourhood::nine, .box_side = BoxSide::snug},
          Policies{.neighbourhood = Neighbourhood::nine, .order = Order::row, .box_side = BoxSide::snug},
          Policies{.order = Order::strips, .overlaps = Overlaps::contacts},
          Policies{.self_contained = SelfContained::off,
                   .storage = Storage::sorted,
                   .overlaps = Overlaps::contacts},
          Policies{.storage = Storage::sorted, .overlaps = Overlaps::contacts},
          Policies{.order = Order::strips,
                   .direction = Direction::forward,
                   .storage = Storage::sorted,
                   .overlaps = Overlaps::contacts},
          Policies{.order = Order::strips, .storage = Storage::sorted, .overlaps = Overlaps::contacts},
          Policies{.search = Search::filtered}, Policies{.worklist = Worklist::active},
          Policies{.order = Order::strips,
                   .self_contained = SelfContained::off,
                   .storage = Storage::sorted,
                   .overlaps = Overlaps::contacts,
                   .impact = Impact::at_contact}}) {
        EXPECT_NE(impossible(policies), "") << name_of(policies).view();
    }
}

TEST(Impossible, GivesAReasonForAskingAheadForWhatStandsInOrder) {
    EXPECT_EQ(impossible({.prefetch = Prefetch::on}), "");
    EXPECT_NE(impossible({.storage = Storage::sorted, .prefetch = Prefetch::on}), "");
}

TEST(Impossible, GivesAReasonForCollisionsAtContactWithoutContacts) {
    EXPECT_NE(impossible(at_contact({})), "");
    EXPECT_EQ(impossible(at_contact(ladder.back())), "");
}

/// How many policies differ.
int differences(const Policies& one, const Policies& two) {
    int count = 0;
    for_each_policy([&](const char* /*policy*/, const char* /*prefix*/, auto axis) {
        count += one.*axis != two.*axis ? 1 : 0;
    });
    return count;
}

TEST(Ladder, ClimbsFromThePublishedBestOnePolicyARung) {
    Policies below;
    for (const Policies& rung : ladder) {
        EXPECT_EQ(differences(below, rung), 1) << name_of(rung).view();
        EXPECT_TRUE(in_table(rung));
        below = rung;
    }
    EXPECT_EQ(below.impact, Impact::step_end) << "the published step is what is climbed with";
    EXPECT_EQ(below.precision, Precision::double_) << "accuracy is not for sale";
}

} // namespace
} // namespace carom
