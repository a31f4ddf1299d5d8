#include <csignal>
#include <string>

#include <gtest/gtest.h>

#include "harness/machine/suspensions.hpp"
#include "harness/support/errors.hpp"

namespace carom {
namespace {

TEST(Suspensions, AreNoticedByTheSignalThatEndsThem) {
    Suspensions suspensions;
    suspensions.start();
    EXPECT_FALSE(suspensions.noticed());
    EXPECT_EQ(suspensions.reason(), std::nullopt);
    EXPECT_NO_THROW(suspensions.require_none("a"));
    std::raise(SIGCONT);
    EXPECT_TRUE(suspensions.noticed());
    EXPECT_EQ(suspensions.reason(), "was suspended for some time while it was measured; measure it again");
    EXPECT_THROW(suspensions.require_none("a"), InputError);
}

TEST(Suspensions, AreNoticedByWhomeverLooksAndForgottenByWhoeverStartsAgain) {
    Suspensions one;
    Suspensions other;
    one.start();
    other.start();
    std::raise(SIGCONT);
    EXPECT_TRUE(one.noticed());
    EXPECT_TRUE(other.noticed());
    one.start();
    EXPECT_FALSE(one.noticed());
}

TEST(Suspensions, AreNoticedWhereTheSignalWasBlocked) {
    sigset_t continuation;
    sigset_t before;
    sigemptyset(&continuation);
    sigaddset(&continuation, SIGCONT);
    pthread_sigmask(SIG_BLOCK, &continuation, &before);
    Suspensions suspensions;
    suspensions.start();
    std::raise(SIGCONT);
    EXPECT_TRUE(suspensions.noticed());
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

} // namespace
} // namespace carom
