#include <gtest/gtest.h>

#include "harness/support/nearest.hpp"

namespace carom {
namespace {

TEST(Nearest, TakesTheFewestChanges) {
    EXPECT_EQ(nearest("trak", {"row", "track", "auto"}), "track");
    EXPECT_EQ(nearest("row", {"row", "rows"}), "row");
    EXPECT_EQ(nearest("", {"long", "a"}), "a");
}

TEST(DidYouMean, NamesOnlyWhatIsNear) {
    EXPECT_EQ(did_you_mean("--thread", {"--threads", "--tag"}), "; did you mean '--threads'?");
    EXPECT_EQ(did_you_mean("runn", {"run", "turns"}), "; did you mean 'run'?");
    EXPECT_EQ(did_you_mean("frobnicate", {"run", "check"}), "");
    EXPECT_EQ(did_you_mean("run", {}), "");
}

} // namespace
} // namespace carom
