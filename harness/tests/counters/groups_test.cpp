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

struct GroupCase {
    const char* what;
    Hardware hardware;
    std::vector<Alternatives> wanted;
    Groups groups;
    std::string missing = {}; ///< the event
    std::string error = {};
};

TEST(EventGroups, HoldWhatIsCountedAtOnceAndTheRestIsMissing) {
    const std::vector<GroupCase> cases{
        {"what fits", {.counters = 4}, {{"a"}, {"b"}, {"c"}, {"d"}}, {{"a", "b", "c", "d"}}},
        {"what does not fit",
         {.counters = 2},
         {{"a"}, {"b"}, {"c"}, {"d"}, {"e"}},
         {{"a", "b"}, {"c", "d"}, {"e"}}},
        {"events that exclude each other",
         {.conflict = {"a", "b"}},
         {{"a"}, {"b"}, {"c"}},
         {{"a", "c"}, {"b"}}},
        {"an unknown one", {.unknown = {"b"}}, {{"a"}, {"b"}, {"c"}}, {{"a", "c"}}, "b", "b is unknown"},
        {"one that does not start",
         {.not_starting = {"a"}},
         {{"a"}, {"b"}},
         {{"b"}},
         "a",
         "start is refused"},
        {"cycles must count, misses need not",
         {.always_zero = {"PAPI_TOT_CYC", "PAPI_L3_TCM"}},
         {{"PAPI_TOT_CYC"}, {"PAPI_L3_TCM"}},
         {{"PAPI_L3_TCM"}},
         "PAPI_TOT_CYC",
         "PAPI_TOT_CYC starts but counts nothing"},
        {"the first alternative that counts", {.unknown = {"a", "b"}}, {{"a", "b", "c", "d"}}, {{"c"}}},
        {"no alternative that counts", {.unknown = {"a", "b"}}, {{"a", "b"}}, {}, "a", "a is unknown"}};
    for (const GroupCase& one : cases) {
        SCOPED_TRACE(one.what);
        const EventGroups found =
            group_events(one.wanted, [&one] { return std::make_unique<FakeSet>(one.hardware); });
        EXPECT_EQ(found.groups, one.groups);
        ASSERT_EQ(found.missing.size(), one.missing.empty() ? 0U : 1U);
        if (!one.missing.empty()) {
            EXPECT_EQ(found.missing[0].event, one.missing);
            EXPECT_EQ(found.missing[0].error, one.error);
        }
    }
}

} // namespace
} // namespace carom
