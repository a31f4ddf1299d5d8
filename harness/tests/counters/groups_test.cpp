#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/counters/groups.hpp"

namespace carom {
namespace {

using Groups = std::vector<std::vector<std::string>>;

/// Hardware as a test wants it.
struct Hardware {
    std::size_t counters = 4;
    std::set<std::string> unknown = {};
    std::set<std::string> not_starting = {};
    std::set<std::string> always_zero = {};
    std::pair<std::string, std::string> conflict = {};
};

class FakeSet : public EventSet {
  public:
    explicit FakeSet(const Hardware& hardware) : hardware_(hardware) {}

    void add(const std::string& event) override {
        if (hardware_.unknown.contains(event)) {
            throw CounterError(event + " is unknown");
        }
        if (events_.size() == hardware_.counters) {
            throw CounterError("no counter is left for " + event);
        }
        events_.push_back(event);
    }

    void start() override {
        const auto has = [this](const std::string& event) {
            return std::ranges::find(events_, event) != events_.end();
        };
        if (std::ranges::any_of(hardware_.not_starting, has)) {
            throw CounterError("start is refused");
        }
        if (has(hardware_.conflict.first) && has(hardware_.conflict.second)) {
            throw CounterError("both need the same counter");
        }
        started_ = true;
    }

    std::vector<double> stop() override {
        EXPECT_TRUE(started_);
        std::vector<double> counts;
        for (const std::string& event : events_) {
            counts.push_back(hardware_.always_zero.contains(event) ? 0 : 7);
        }
        return counts;
    }

  private:
    const Hardware& hardware_;
    std::vector<std::string> events_;
    bool started_ = false;
};

EventGroups group(const Hardware& hardware, const std::vector<Alternatives>& wanted) {
    return group_events(wanted, [&hardware] { return std::make_unique<FakeSet>(hardware); });
}

TEST(EventGroups, WhatFitsIsCountedAtOnce) {
    const EventGroups found = group({.counters = 4}, {{"a"}, {"b"}, {"c"}, {"d"}});
    EXPECT_EQ(found.groups, (Groups{{"a", "b", "c", "d"}}));
    EXPECT_TRUE(found.missing.empty());
}

TEST(EventGroups, WhatDoesNotFitStartsTheNextGroup) {
    const EventGroups found = group({.counters = 2}, {{"a"}, {"b"}, {"c"}, {"d"}, {"e"}});
    EXPECT_EQ(found.groups, (Groups{{"a", "b"}, {"c", "d"}, {"e"}}));
    EXPECT_TRUE(found.missing.empty());
}

TEST(EventGroups, EventsThatExcludeEachOtherAreKeptApart) {
    const EventGroups found = group({.conflict = {"a", "b"}}, {{"a"}, {"b"}, {"c"}});
    EXPECT_EQ(found.groups, (Groups{{"a", "c"}, {"b"}}));
    EXPECT_TRUE(found.missing.empty());
}

TEST(EventGroups, AnUnknownEventIsMissingAndKeepsNoOtherOut) {
    const EventGroups found = group({.unknown = {"b"}}, {{"a"}, {"b"}, {"c"}});
    EXPECT_EQ(found.groups, (Groups{{"a", "c"}}));
    ASSERT_EQ(found.missing.size(), 1U);
    EXPECT_EQ(found.missing[0].event, "b");
    EXPECT_EQ(found.missing[0].error, "b is unknown");
}

TEST(EventGroups, AnEventThatCanBeAddedButNotStartedIsMissing) {
    const EventGroups found = group({.not_starting = {"a"}}, {{"a"}, {"b"}});
    EXPECT_EQ(found.groups, (Groups{{"b"}}));
    ASSERT_EQ(found.missing.size(), 1U);
    EXPECT_EQ(found.missing[0].error, "start is refused");
}

TEST(EventGroups, CyclesThatStayZeroAreMissingButMissesMayBeZero) {
    const EventGroups found =
        group({.always_zero = {"PAPI_TOT_CYC", "PAPI_L3_TCM"}}, {{"PAPI_TOT_CYC"}, {"PAPI_L3_TCM"}});
    EXPECT_EQ(found.groups, (Groups{{"PAPI_L3_TCM"}}));
    ASSERT_EQ(found.missing.size(), 1U);
    EXPECT_EQ(found.missing[0].event, "PAPI_TOT_CYC");
    EXPECT_NE(found.missing[0].error.find("counts nothing"), std::string::npos);
}

TEST(EventGroups, TheFirstAlternativeThatCountsIsTaken) {
    const EventGroups found = group({.unknown = {"a", "b"}}, {{"a", "b", "c", "d"}});
    EXPECT_EQ(found.groups, (Groups{{"c"}}));
    EXPECT_TRUE(found.missing.empty());
}

TEST(EventGroups, WithoutAnyAlternativeTheFirstIsNamed) {
    const EventGroups found = group({.unknown = {"a", "b"}}, {{"a", "b"}});
    EXPECT_TRUE(found.groups.empty());
    ASSERT_EQ(found.missing.size(), 1U);
    EXPECT_EQ(found.missing[0].event, "a");
    EXPECT_EQ(found.missing[0].error, "a is unknown");
}

} // namespace
} // namespace carom
