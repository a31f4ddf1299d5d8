#include <string>

#include <gtest/gtest.h>

#include "harness/counters/cachegrind_output.hpp"
#include "harness/counters/event_set.hpp"

namespace carom {
namespace {

const std::string header = "desc: I1 cache:         32768 B, 64 B, 8-way associative\n"
                           "desc: D1 cache:         49152 B, 64 B, 12-way associative\n"
                           "desc: LL cache:         8388608 B, 64 B, 16-way associative\n"
                           "cmd: carom run scene.in 1\n";
const std::string events = "events: Ir I1mr ILmr Dr D1mr DLmr Dw D1mw DLmw Bc Bcm Bi Bim\n";
const std::string functions = "fl=step.hpp\nfn=step\n12 5 0 0 2 0 0 1 0 0 1 0 0 0\n";

std::string error_of(const std::string& text) {
    try {
        parse_cachegrind(text);
    } catch (const CounterError& error) {
        return error.what();
    }
    return "";
}

TEST(SimulatedOutput, ReadsTotalsAndCacheSizes) {
    const auto values =
        parse_cachegrind(header + events + functions +
                         "summary: 208677938 11509 4975 52083134 3102546 22845 12708080 217466 "
                         "63262 26761639 2537906 1171283 5361\n");
    EXPECT_EQ(values.at("instructions"), 208677938);
    EXPECT_EQ(values.at("l1_read_misses"), 3102546);
    EXPECT_EQ(values.at("llc_write_misses"), 63262);
    EXPECT_EQ(values.at("conditional_branch_misses"), 2537906);
    EXPECT_EQ(values.at("indirect_branch_misses"), 5361);
    EXPECT_EQ(values.at("l1_data_cache_bytes"), 49152);
    EXPECT_EQ(values.at("llc_bytes"), 8388608);
    EXPECT_EQ(values.size(), simulated_counts().size() + simulated_sizes().size());
}

TEST(SimulatedOutput, TakesTheEventsInTheirOwnOrder) {
    const auto values =
        parse_cachegrind(header + "events: Bim Ir I1mr ILmr Dr D1mr DLmr Dw D1mw DLmw Bc Bcm Bi\n" +
                         "summary: 1 2 3 4 5 6 7 8 9 10 11 12 13\n");
    EXPECT_EQ(values.at("indirect_branch_misses"), 1);
    EXPECT_EQ(values.at("instructions"), 2);
    EXPECT_EQ(values.at("indirect_branches"), 13);
}

TEST(SimulatedOutput, SaysWhatIsWrong) {
    const std::string summary = "summary: 1 2 3 4 5 6 7 8 9 10 11 12 13\n";
    EXPECT_EQ(error_of(header + events + summary), "");
    EXPECT_NE(error_of(header + summary).find("found no line `events:`"), std::string::npos);
    EXPECT_NE(error_of(header + events).find("found no line `summary:`"), std::string::npos);
    EXPECT_NE(error_of(events + summary).find("found no line `desc: I1 cache:`"), std::string::npos);
    EXPECT_NE(error_of(header + events + "summary: 1 2\n").find("found 2 totals"), std::string::npos);
    EXPECT_NE(error_of(header + events + "summary: 1 2 x 4 5 6 7 8 9 10 11 12 13\n").find("found 'x'"),
              std::string::npos);
    EXPECT_NE(error_of(header + "events: Ir\nsummary: 1\n").find("no event I1mr"), std::string::npos);
    EXPECT_NE(error_of("").find("found no line"), std::string::npos);
}

} // namespace
} // namespace carom
