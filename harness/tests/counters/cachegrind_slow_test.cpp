#include <string>

#include <gtest/gtest.h>

#include "harness/tests/counters/simulated_scene.hpp"

namespace carom {
namespace {

class SimulatedSteps : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string obstacle = tests::no_simulation(); !obstacle.empty()) {
            GTEST_SKIP() << obstacle;
        }
    }
};

TEST_F(SimulatedSteps, AreAllThatCounts) {
    auto one = tests::simulate("published", 1);
    auto two = tests::simulate("published", 2);
    EXPECT_EQ(one.at("steps"), 1);
    EXPECT_EQ(two.at("steps"), 2);
    // Fewer could not move a thousand discs; more would be start-up that was not subtracted.
    EXPECT_GT(one.at("instructions"), 1e4);
    EXPECT_LT(one.at("instructions"), 1e7);
    EXPECT_GT(two.at("instructions"), 1.5 * one.at("instructions"));
    EXPECT_LT(two.at("instructions"), 2.5 * one.at("instructions"));
    EXPECT_LT(one.at("l1_read_misses"), one.at("data_reads"));
    EXPECT_LT(one.at("conditional_branch_misses"), one.at("conditional_branches"));
    EXPECT_GT(one.at("l1_data_cache_bytes"), 1024);
}

TEST_F(SimulatedSteps, AreReproducibleAndTellFourBoxesFromNine) {
    const double four = tests::simulate("published", 5).at("instructions");
    const double nine = tests::simulate("nine", 5).at("instructions");
    // Of the 8 million some 15 000 come and go from process to process.
    EXPECT_NEAR(tests::simulate("published", 5).at("instructions"), four, 5e-3 * four);
    EXPECT_NEAR(tests::simulate("nine", 5).at("instructions"), nine, 5e-3 * nine);
    // Nine boxes hold more than twice the candidates of four, of which finding makes up most of a step.
    EXPECT_GT(nine, 1.05 * four);
}

} // namespace
} // namespace carom
