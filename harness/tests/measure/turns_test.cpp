#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "harness/measure/measurement.hpp"
#include "harness/measure/turns.hpp"
#include "kernels/tests/scenes.hpp"
#include "variants/registry.hpp"

namespace carom {
namespace {

/// Notes when its turns come; a turn of n steps takes n seconds.
class Diarist final : public Contender {
  public:
    Diarist(int number, int steps, std::vector<int>& diary) : number_(number), steps_(steps), diary_(diary) {}

    int steps() const override { return steps_; }
    void start() override { starts.push_back(static_cast<int>(taken.size())); }
    TurnTime advance(int steps) override {
        diary_.push_back(number_);
        taken.push_back(steps);
        return {.steps = steps, .seconds = static_cast<double>(steps), .returning_seconds = std::nullopt};
    }

    std::vector<int> taken;  ///< steps of each turn
    std::vector<int> starts; ///< of each run, how many turns were before it

  private:
    int number_;
    int steps_;
    std::vector<int>& diary_;
};

TEST(Turns, EachTakesOneInEveryRoundAndAllItsStepsInAll) {
    std::vector<int> diary;
    Diarist one(0, 100, diary);
    Diarist two(1, 37, diary);
    Diarist three(2, 10, diary);
    const std::vector<Contender*> everyone{&one, &two, &three};
    const auto turns = take_turns(everyone, {.runs = 1, .rounds = 10, .seed = 1});
    ASSERT_EQ(diary.size(), 30);
    for (auto round = diary.begin(); round != diary.end(); round += 3) {
        std::vector<int> turn(round, round + 3);
        std::ranges::sort(turn);
        EXPECT_EQ(turn, (std::vector<int>{0, 1, 2}));
    }
    for (const auto& [who, steps] : {std::pair{&one, 100}, {&two, 37}, {&three, 10}}) {
        EXPECT_EQ(who->taken.size(), 10);
        EXPECT_EQ(std::accumulate(who->taken.begin(), who->taken.end(), 0), steps);
        EXPECT_LE(std::ranges::max(who->taken) - std::ranges::min(who->taken), 1);
    }
    ASSERT_EQ(turns[2].size(), 10);
    EXPECT_TRUE(std::ranges::all_of(turns[2], [](const TurnTime& turn) { return turn.seconds == 1; }));
    for (std::size_t who = 0; who < turns.size(); ++who) {
        for (const TurnTime& turn : turns[who]) {
            EXPECT_EQ(diary[static_cast<std::size_t>(turn.place)], static_cast<int>(who));
        }
    }
}

TEST(Turns, EverySecondRunBeginsWithHalfATurn) {
    std::vector<int> diary;
    Diarist one(0, 12, diary);
    const std::vector<Contender*> alone{&one};
    const auto turns = take_turns(alone, {.runs = 2, .rounds = 6, .seed = 1});
    EXPECT_EQ(one.taken, (std::vector<int>{1, 2, 2, 2, 2, 3, 2, 2, 2, 2, 2, 2}));
    one.taken.clear();
    take_turns(alone, {.runs = 1, .rounds = 12, .seed = 1});
    EXPECT_EQ(one.taken, std::vector<int>(12, 1)) << "a step cannot be halved";
    EXPECT_EQ(turns[0].front().steps, 1);
}

TEST(Turns, TheirOrderIsDrawnAnewInEachRoundAndFollowsTheSeed) {
    const auto diary_of = [](std::uint64_t seed) {
        std::vector<int> diary;
        Diarist one(0, 1000, diary);
        Diarist two(1, 1000, diary);
        const std::vector<Contender*> both{&one, &two};
        take_turns(both, {.runs = 1, .rounds = 1000, .seed = seed});
        return diary;
    };
    const std::vector<int> diary = diary_of(1);
    int first = 0;
    for (std::size_t k = 0; k < diary.size(); k += 2) {
        first += diary[k] == 0;
    }
    EXPECT_NEAR(first, 500, 80) << "five standard deviations";
    EXPECT_EQ(diary, diary_of(1));
    EXPECT_NE(diary, diary_of(2));
}

TEST(Turns, AllStartAgainTogetherAndTheOrderIsAnotherOne) {
    std::vector<int> diary;
    Diarist one(0, 20, diary);
    Diarist two(1, 20, diary);
    const std::vector<Contender*> both{&one, &two};
    const auto turns = take_turns(both, {.runs = 3, .rounds = 20, .seed = 4});
    EXPECT_EQ(one.starts, (std::vector<int>{0, 20, 40}));
    EXPECT_EQ(two.starts, one.starts);
    EXPECT_EQ(turns[0].size(), 60);
    EXPECT_EQ(std::accumulate(one.taken.begin(), one.taken.end(), 0), 60);
    const auto run = [&diary](int number) {
        return std::vector<int>(diary.begin() + 40 * number, diary.begin() + 40 * (number + 1));
    };
    EXPECT_NE(run(0), run(1));
    EXPECT_NE(run(1), run(2));
}

TEST(Turns, AreAsLongAsAskedButNoShorterThanAStep) {
    EXPECT_EQ(count_rounds(std::vector{1.0, 2.0, 100.0}, 1000, 0.05), 40);
    EXPECT_EQ(count_rounds(std::vector{1.0, 2.0, 100.0}, 31, 0.05), 15) << "two steps at least";
    EXPECT_EQ(count_rounds(std::vector{1.0}, 1, 0.05), 1);
    EXPECT_EQ(count_rounds(std::vector{0.01}, 30, 0.05), 1);
    EXPECT_EQ(count_rounds(std::vector{0.0}, 0, 0.05), 1);
}

carom::Run run_to(const std::vector<Disc>& discs) {
    carom::Run run;
    run.discs = discs;
    return run;
}

TEST(Measurement, ALaterRunHasToEndInTheSameBitsAfterTheSameWork) {
    const Scene scene = tests::random_scene_of_density(20, 0.2, 3, 5);
    const auto violation_after = [&scene](const carom::Run& second) {
        Measurement measurement{.scene = scene,
                                .scene_name = "scene.in",
                                .scene_sha256 = {},
                                .variant = *find_variant("published"),
                                .tuning = {}};
        measurement.add(run_to(scene.discs));
        measurement.add(second);
        return measurement.violation.value_or("");
    };
    EXPECT_EQ(violation_after(run_to(scene.discs)), "");
    std::vector<Disc> moved = scene.discs;
    moved.back().x = std::nextafter(moved.back().x, 1e9);
    carom::Run other = run_to(moved);
    EXPECT_EQ(violation_after(other), "the final state differs from the one of the run before");
    other.violation = "a step is wrong";
    EXPECT_EQ(violation_after(other), "a step is wrong");
    carom::Run busier = run_to(scene.discs);
    busier.work.pair_resolves = 1;
    EXPECT_NE(violation_after(busier).find("the work differs"), std::string::npos);
}

} // namespace
} // namespace carom
