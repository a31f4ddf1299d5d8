#include <gtest/gtest.h>

#include "harness/machine/threads.hpp"

namespace carom {
namespace {

TEST(FreeProcessors, AreOneAtLeastAndNoMoreThanMayBeUsed) {
    const int free = free_processors();
    EXPECT_GE(free, 1);
    EXPECT_LE(free, usable_processors());
}

TEST(FreeProcessors, AreThoseThatNoRunningThreadHas) {
    EXPECT_EQ(parse_running("0.50 0.40 0.30 3/123 4567"), 3);
    EXPECT_EQ(parse_running("12.50 10.40 9.30 17/1234 4567"), 17);
    for (const char* wrong : {"", "0.50 0.40 0.30", "0.50 0.40 0.30 3 123", "0.5 0.4 0.3 many/1 2"}) {
        EXPECT_FALSE(parse_running(wrong)) << wrong;
    }
}

TEST(Threads, ByThemselvesAreNoMoreThanGranted) { EXPECT_NO_THROW(require_threads(default_threads())); }

} // namespace
} // namespace carom
