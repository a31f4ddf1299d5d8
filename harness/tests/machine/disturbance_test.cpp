#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "harness/machine/disturbance.hpp"

namespace carom {
namespace {

const Disturbance quiet{.seconds = 2, .waited = 0.01, .stolen = 0.001, .load = 1.5, .processors = 4};

TEST(BusyText, IsNothingWhereNobodyDisturbed) {
    EXPECT_FALSE(busy_text(quiet, 4));
    EXPECT_FALSE(busy_text({.seconds = 2, .waited = {}, .stolen = {}, .load = {}}, 1)) << "nothing is known";
    Disturbance brief = quiet;
    brief.seconds = 0.001;
    brief.waited = 0.001;
    EXPECT_FALSE(busy_text(brief, 4)) << "too short to tell";
}

TEST(BusyText, TellsWhatIsKnown) {
    Disturbance busy = quiet;
    busy.waited = 0.8;
    EXPECT_EQ(busy_text(busy, 2),
              "the machine was busy: threads were kept waiting for a processor, 0.8 s together in "
              "2 s (load 1.5 on 4 processors); on a quiet one this takes less time");
    busy.stolen = 0.07;
    EXPECT_PRED_FORMAT2(testing::IsSubstring, "0.8 s together in 2 s, 7 % of its time went to other machines",
                        *busy_text(busy, 2));
    busy.load = {};
    busy.waited = {};
    EXPECT_EQ(busy_text(busy, 2),
              "the machine was busy: 7 % of its time went to other machines of its host; on a "
              "quiet one this takes less time");
}

TEST(BusyText, DoesNotBlameOthersForThreadsThatWaitForEachOther) {
    Disturbance crowded = quiet;
    crowded.waited = 5;
    EXPECT_FALSE(busy_text(crowded, 5));
    EXPECT_TRUE(busy_text(crowded, 4));
}

TEST(DisturbanceWatch, LooksAtItsOwnTime) {
    const DisturbanceWatch watch;
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    const Disturbance found = watch.until_now();
    EXPECT_GE(found.seconds, 0.03);
    EXPECT_GE(found.processors, 1);
    EXPECT_GE(found.waited.value_or(0), 0);
}

} // namespace
} // namespace carom
