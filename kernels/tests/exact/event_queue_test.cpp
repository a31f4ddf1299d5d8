#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernels/exact/event_queue.hpp"
#include "kernels/tests/scenes.hpp"

namespace carom::tests {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// What an EventQueue does, done plainly.
template <class Real> class PlainQueue {
  public:
    explicit PlainQueue(int count) : times_(static_cast<std::size_t>(count), static_cast<Real>(never)) {
        for (int disc = 0; disc < count; ++disc) {
            events_.insert({static_cast<Real>(never), disc});
        }
    }

    std::pair<Real, int> earliest() const { return *events_.begin(); }
    int coming(int count) const { return std::next(events_.begin(), count)->second; }

    void set(int disc, Real time) {
        events_.erase({times_[static_cast<std::size_t>(disc)], disc});
        times_[static_cast<std::size_t>(disc)] = time;
        events_.insert({time, disc});
    }

  private:
    std::vector<Real> times_;
    std::set<std::pair<Real, int>> events_;
};

/// How long from now, `now`, until a disc's next event.
using Delay = std::function<double(Random&, double now)>;

struct NamedDelay {
    std::string name;
    Delay delay;
};

std::vector<NamedDelay> delays() {
    return {
        {"even", [](Random& random, double) { return random.uniform(0, 1); }},
        {"at one of few instants", [](Random& random, double) { return 0.25 * random.below(4); }},
        {"all at one instant, then all later", [](Random&, double now) { return now < 1 ? 0.5 : 2; }},
        {"over twelve decades", [](Random& random, double) { return random.magnitude(-9, 3); }},
        {"one in a thousand a long time away",
         [](Random& random, double) { return random.below(1000) == 0 ? 1e9 : random.uniform(0, 1); }},
        {"half never", [](Random& random, double) { return random.coin() ? never : random.uniform(0, 1); }},
        {"a thousand times as often from 3 on, then as before",
         [](Random& random, double now) { return random.uniform(0, now > 3 && now < 3.01 ? 1e-3 : 1); }},
        {"less and less often",
         [](Random& random, double now) { return (0.1 + now) * random.uniform(0, 2); }},
        {"ever more often", [](Random& random, double now) { return (4 - now) * random.uniform(0, 0.01); }}};
}

/// Lets discs have one event after another, at each of which the disc's next one and now and then that of
/// another disc are set anew; returns after how many of them the queue differed from the plain one, -1 if
/// after none.
template <class Real> int differs_after(int count, const Delay& delay, int events) {
    Random random(static_cast<std::uint64_t>(count));
    EventQueue<Real> queue(count);
    PlainQueue<Real> plain(count);
    const auto set = [&](int disc, Real time) {
        queue.set(disc, time, disc);
        plain.set(disc, time);
    };
    for (int disc = 0; disc < count; ++disc) {
        set(disc, static_cast<Real>(delay(random, 0)));
    }
    Real now = 0;
    for (int event = 0; event < events; ++event) {
        const auto [time, disc] = plain.earliest();
        if (queue.earliest_time() != time || (time < static_cast<Real>(never) && queue.earliest() != disc)) {
            return event;
        }
        now = time < static_cast<Real>(never) ? time : now;
        set(disc, now + static_cast<Real>(delay(random, static_cast<double>(now))));
        if (random.coin()) {
            set(random.below(count), now + static_cast<Real>(delay(random, static_cast<double>(now))));
        }
    }
    return -1;
}

TEST(EventQueue, GivesEventsInOrderHoweverTheyLieInTime) {
    for (const auto& [name, delay] : delays()) {
        for (const int count : {1, 2, 5, 8, 17, 100, 1000}) {
            EXPECT_EQ(differs_after<double>(count, delay, 20'000), -1) << name << ", " << count;
        }
        EXPECT_EQ(differs_after<long double>(300, delay, 20'000), -1) << name << ", long double";
    }
}

TEST(EventQueue, TellsInfinityAsLongAsNothingIsToCome) {
    EventQueue<double> of_none(0);
    EXPECT_EQ(of_none.earliest_time(), never);
    EventQueue<double> queue(3);
    EXPECT_EQ(queue.earliest_time(), never);
    queue.set(1, 5, 1);
    EXPECT_EQ(queue.earliest_time(), 5);
    EXPECT_EQ(queue.earliest(), 1);
    queue.set(1, never, 1);
    EXPECT_EQ(queue.earliest_time(), never);
    queue.set(2, 4, 2);
    EXPECT_EQ(queue.earliest_time(), 4) << "earlier than what has been there";
    EXPECT_EQ(queue.earliest(), 2);
}

TEST(EventQueue, GivesEventsOfOneInstantInTheOrderOfTheirDiscs) {
    EventQueue<double> queue(50);
    for (int disc = 49; disc >= 0; --disc) {
        queue.set(disc, 1, disc);
    }
    for (int disc = 0; disc < 50; ++disc) {
        ASSERT_EQ(queue.earliest_time(), 1);
        EXPECT_EQ(queue.earliest(), disc);
        queue.set(disc, 2, disc);
    }
    EXPECT_EQ(queue.earliest_time(), 2);
}

/// Whichever of the two discs foresaw their collision, it comes at the same place among those of its instant.
TEST(EventQueue, OrdersEventsOfOneInstantByBothOfTheirDiscs) {
    EventQueue<double> queue(10);
    queue.set(3, 1, 3);
    queue.set(9, 1, 2);
    queue.set(2, 1, 7);
    queue.set(8, 1, 1);
    queue.set(5, 1, -1);
    for (const int disc : {5, 8, 2, 9, 3}) {
        ASSERT_EQ(queue.earliest_time(), 1);
        EXPECT_EQ(queue.earliest(), disc);
        queue.set(disc, 2, disc);
    }
    queue.set(4, 1.5, 4);
    queue.set(4, 1.5, 0);
    queue.set(1, 1.5, 3);
    ASSERT_EQ(queue.earliest_time(), 1.5);
    EXPECT_EQ(queue.earliest(), 4) << "with another partner at the same time";
}

/// Where no event comes before those that are known, only the ends of years may hide one.
TEST(EventQueue, KnowsWhatComesNextAsARule) {
    constexpr int count = 1000;
    constexpr int events = 20'000;
    Random random(3);
    EventQueue<double> queue(count);
    PlainQueue<double> plain(count);
    const auto set = [&](int disc, double time) {
        queue.set(disc, time, disc);
        plain.set(disc, time);
    };
    for (int disc = 0; disc < count; ++disc) {
        set(disc, random.uniform(0, 1));
    }
    int known = 0;
    for (int event = 0; event < events; ++event) {
        const double now = queue.earliest_time();
        for (int k = 0; k <= static_cast<int>(EventQueue<double>::ahead); ++k) {
            known += queue.coming(static_cast<std::size_t>(k)) == plain.coming(k) ? 1 : 0;
        }
        set(queue.earliest(), now + random.uniform(0.5, 1.5));
    }
    EXPECT_GT(known, 0.99 * events * (1 + EventQueue<double>::ahead));
}

TEST(EventQueue, OrdersEventsOfOneInstantByTheNumbersOfTheDiscs) {
    const std::vector<int> falling = {30, 20, 10};
    EventQueue<double> queue(2);
    queue.set(0, 1, 1);
    queue.number(falling); // makes room for a third disc
    queue.set(2, 1, 2);
    EXPECT_EQ(queue.earliest_time(), 1);
    EXPECT_EQ(queue.earliest(), 2);
    queue.set(1, 1, -1); // of nobody else: before all others
    EXPECT_EQ(queue.earliest_time(), 1);
    EXPECT_EQ(queue.earliest(), 1);
}

} // namespace
} // namespace carom::tests
