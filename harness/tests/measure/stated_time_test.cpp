#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/measure/stated_time.hpp"
#include "harness/support/errors.hpp"

namespace carom {
namespace {

using Json = nlohmann::json;

std::string refusal(const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(StatedTime, IsTheNumberInTheGroup) {
    const std::string output = "reading 3.5 ms\nsteps took 12.25 ms of it\ndone\n";
    EXPECT_DOUBLE_EQ(time_in_output(output, "steps took ([0-9.]+) ms", 1e-3).seconds, 0.01225);
    EXPECT_DOUBLE_EQ(time_in_output("1e-3\n", "^(\\S+)$", 1).seconds, 0.001);
}

TEST(StatedTime, IsNeverAPartOfALongerNumber) {
    const auto said = [](const std::string& output, const std::string& pattern) {
        return refusal([&] { time_in_output(output, pattern, 1); });
    };
    EXPECT_EQ(
        said("took 3,5 ms\n", "took ([0-9.]+)"),
        "time: found '3' within a longer number in 'took 3,5 ms', expected a pattern that takes all of it");
    for (const char* line : {"took 3.25 ms\n", "took 13.25 ms\n", "took 3,25 ms\n"}) {
        EXPECT_NE(said(line, "([0-9]+) ms").find("within a longer number"), std::string::npos) << line;
    }
    EXPECT_NE(said("took 3e-5\n", "took ([0-9]+)").find("within a longer number"), std::string::npos);
    EXPECT_NE(said("took 31\n", "took ([0-9])").find("within a longer number"), std::string::npos);
    EXPECT_EQ(said("took 3. Done\n", "took ([0-9]+)"), "");
    EXPECT_EQ(said("took 3, which is 4 s\n", "took ([0-9]+)"), "");
    EXPECT_EQ(said("took 3.5 s\n", "took ([0-9]+)\\.[0-9] s"), "") << "the pattern says what follows";
    EXPECT_EQ(said("2 runs: 3elapsed\n", ": ([0-9]+)"), "");
}

TEST(StatedTime, RefusesWhatTellsNone) {
    const auto said = [](const std::string& output, const std::string& pattern) {
        return refusal([&] { time_in_output(output, pattern, 1); });
    };
    EXPECT_EQ(said("a 1\n", "b ([0-9]+)"),
              "time: 'b ([0-9]+)' matches 0 lines of standard output, expected one");
    EXPECT_EQ(said("a 1\na 2\n", "a ([0-9]+)"),
              "time: 'a ([0-9]+)' matches 2 lines of standard output, expected one");
    EXPECT_EQ(said("a x\n", "a (.)"), "time: found 'x', expected a positive number");
    EXPECT_EQ(said("a 0\n", "a (.)"), "time: found '0', expected a positive number");
    EXPECT_EQ(said("a -1\n", "a (.*)"), "time: found '-1', expected a positive number");
    EXPECT_EQ(said("a 1\n", "a ("), "time: found 'a (', expected a regular expression");
    EXPECT_EQ(said("a 1\n", "a 1"), "time: found 'a 1', expected a regular expression with one group");
    EXPECT_EQ(said(std::string(1'000'000, 'a') + "\n", "(a|b)*c"),
              "time: '(a|b)*c' matches 0 lines of standard output, expected one");
}

} // namespace
} // namespace carom
