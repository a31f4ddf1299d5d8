#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

/// The time of a line, without another unit, in seconds.
double seconds(const std::string& line, const std::string& pattern) {
    return time_in_output(line + "\n", pattern).seconds;
}

std::string said(const std::string& output, const std::string& pattern, std::optional<double> unit = 1) {
    return refusal([&] { time_in_output(output, pattern, unit); });
}

TEST(StatedTime, IsTheNumberInTheGroup) {
    const std::string output = "reading 3.5 ms\nsteps took 12.25 ms of it\ndone\n";
    EXPECT_DOUBLE_EQ(time_in_output(output, "steps took ([0-9.]+) ms", 1).seconds, 0.01225);
    EXPECT_DOUBLE_EQ(time_in_output("1e-3\n", "^(\\S+)$", 60).seconds, 0.06);
    EXPECT_DOUBLE_EQ(time_in_output("took 12. Done\n", "took ([0-9.]+)", 1).seconds, 12);
    EXPECT_DOUBLE_EQ(seconds("1.5e-3 s", "(.*)"), 0.0015);
}

TEST(StatedTime, HasTheUnitThatStandsBehindItOrWithIt) {
    const std::vector<std::pair<std::string, double>> units{{"ns", 1e-9},
                                                            {" us", 1e-6},
                                                            {" \xC2\xB5s", 1e-6},
                                                            {" \xCE\xBCs", 1e-6},
                                                            {"\xB5s", 1e-6},
                                                            {"\xEF\xBF\xBDs", 1e-6},
                                                            {"\tms", 1e-3},
                                                            {"s", 1},
                                                            {" sec", 1},
                                                            {" secs", 1},
                                                            {" second", 1},
                                                            {" Seconds", 1},
                                                            {" min", 60},
                                                            {" minute", 60},
                                                            {" minutes", 60},
                                                            {"h", 3600},
                                                            {" hour", 3600},
                                                            {" hours", 3600},
                                                            {" hr", 3600},
                                                            {" milliseconds", 1e-3},
                                                            {" microseconds", 1e-6},
                                                            {" nanoseconds", 1e-9},
                                                            {" msec", 1e-3},
                                                            {" usecs", 1e-6}};
    for (const auto& [unit, its_seconds] : units) {
        EXPECT_DOUBLE_EQ(time_in_output("it took 2.5" + unit + ".\n", "took ([0-9.]+)", 7).seconds,
                         2.5 * its_seconds)
            << unit;
        EXPECT_DOUBLE_EQ(seconds("it took 2.5" + unit, "took (.*)"), 2.5 * its_seconds) << unit;
    }
    EXPECT_DOUBLE_EQ(seconds("time: 1.1 ms", "time: ([0-9.]+) (?:ms|s)"), 1.1e-3);
    EXPECT_DOUBLE_EQ(seconds("12.5 ms/step", "([0-9.]+)"), 0.0125);
    for (const char* none :
         {"12 steps", "12", "12 m", "12 MS", "12 s2", "12 h\xC3\xA9lices", "12 ms_total", "12, s"}) {
        EXPECT_EQ(said(std::string(none) + "\n", "([0-9]+)(?: s2)?", std::nullopt),
                  "time: found '12' without a unit behind it, expected one such as ms, or --unit")
            << none;
        EXPECT_DOUBLE_EQ(time_in_output(none, "([0-9]+)(?: s2)?", 0.5).seconds, 6) << none;
    }
    EXPECT_EQ(said("took 12.5 ms total\n", "took (.*)"),
              "time: found '12.5 ms total', expected a number, and behind it at most a unit: ns, us, ms, s, "
              "min or h");
}

TEST(StatedTime, IsNotWhatABlankSeparatesFromItsThousands) {
    EXPECT_EQ(said("took 1 234 ms\n", "([0-9]+) ms"), "time: found '234' within a longer number in 'took 1 "
                                                      "234 ms', expected a pattern that takes all of it");
    EXPECT_EQ(said("took 1 234 ms\n", "took ([0-9]+)"),
              "time: found '1' within a longer number in 'took 1 234 ms', expected a pattern that takes all "
              "of it");
    EXPECT_EQ(said("took 5m\n", "took ([0-9]+)"), "time: found '5' with the unit 'm', expected a time");
    EXPECT_EQ(said("took 5kms\n", "took ([0-9]+)"), "time: found '5' with the unit 'kms', expected a time");
    EXPECT_DOUBLE_EQ(time_in_output("took 5ticks\n", "took ([0-9]+)ticks", 1).seconds, 5)
        << "as the pattern says";
    EXPECT_NE(said("took 1:02.5 s\n", "took ([0-9.]+)"), "") << "minutes before a colon";
    EXPECT_DOUBLE_EQ(seconds("run 1 234 ms", " ([0-9]+) ms"), 0.234) << "the pattern knows the blank";
    EXPECT_DOUBLE_EQ(time_in_output("took 1 234\n", "took ([0-9]+) [0-9]+", 1).seconds, 1);
    EXPECT_DOUBLE_EQ(seconds("run 1 23 ms", "([0-9]+) ms"), 0.023);
    EXPECT_DOUBLE_EQ(seconds("0.5 234 ms", "([0-9]+) ms"), 0.234);
}

TEST(StatedTime, IsNoAmountOfSomethingElse) {
    for (const char* unit : {"MB/s", "GB", "B", "%", "KiB", "Hz", "ks"}) {
        EXPECT_EQ(said(std::string("12 ") + unit + "\n", "([0-9]+)", 1),
                  std::string("time: found '12' with the unit '") + unit + "', expected a time");
    }
}

TEST(StatedTime, MayBeOfHoursMinutesAndSeconds) {
    EXPECT_DOUBLE_EQ(seconds("real\t0m1.234s", "real\\s+(\\S+)"), 1.234);
    EXPECT_DOUBLE_EQ(seconds("real\t2m1.5s", "real\\s+([0-9m.]+)s"), 121.5);
    EXPECT_DOUBLE_EQ(seconds("1h2m3s", "(\\S+)"), 3723);
    EXPECT_DOUBLE_EQ(seconds("1h30m", "(\\S+)"), 5400);
    EXPECT_DOUBLE_EQ(seconds("took 2 minutes, 1.5 seconds", "took (.*)"), 121.5);
    EXPECT_DOUBLE_EQ(seconds("real 0m1,234s", "real (.*)"), 1.234) << "a second has no thousands in a minute";
    EXPECT_DOUBLE_EQ(seconds("real 0m1.2s", "m([0-9.]+)s"), 1.2);
    EXPECT_DOUBLE_EQ(seconds("0:01.5 s elapsed", ":([0-9.]+)"), 1.5);
    for (const auto& [line, pattern] :
         std::vector<std::pair<std::string, std::string>>{{"real 1m1.2s", "m([0-9.]+)s"},
                                                          {"real 1m1.2s", " ([0-9]+)m"},
                                                          {"real 1m1.2s", "([0-9.]+)s"},
                                                          {"1h0m3s", "m([0-9]+)s"},
                                                          {"2 minutes and 3 seconds", "([0-9]+) seconds"},
                                                          {"1:02.5 elapsed", ":([0-9.]+)"},
                                                          {"1:00:02.5 elapsed", ":([0-9.]+) "}}) {
        EXPECT_NE(said(line + "\n", pattern).find("within a longer number"), std::string::npos)
            << line << pattern;
    }
}

TEST(StatedTime, MayHaveADecimalCommaOrGroups) {
    const std::string all = "t ([0-9.,]+)";
    EXPECT_DOUBLE_EQ(seconds("t 1,234.5 s", all), 1234.5);
    EXPECT_DOUBLE_EQ(seconds("t 1.234,5 s", all), 1234.5);
    EXPECT_DOUBLE_EQ(seconds("t 1,234,567 s", all), 1234567);
    EXPECT_DOUBLE_EQ(seconds("t 1.234.567 s", all), 1234567);
    EXPECT_DOUBLE_EQ(seconds("t 0,15 s", all), 0.15);
    EXPECT_DOUBLE_EQ(seconds("t 0,150 s", all), 0.15);
    EXPECT_DOUBLE_EQ(seconds("t 12,5 s", all), 12.5);
    EXPECT_DOUBLE_EQ(seconds("t 1234,567 s", all), 1234.567);
    EXPECT_DOUBLE_EQ(seconds("t 1.234 s", all), 1.234);
    for (const char* number : {"1,234", "12,345", "123,456"}) {
        EXPECT_EQ(said(std::string("t ") + number + " s\n", all),
                  std::string("time: found '") + number +
                      "', which is ambiguous (thousands, or decimals?), expected a decimal point");
    }
    for (const char* number : {"1'234", "1_234", "1 234", "1,23.4", "1,2,3", "1..5", "0x10", "+5"}) {
        EXPECT_EQ(said(std::string("t ") + number + "\n", "t (.*)"),
                  std::string("time: found '") + number + "', expected a positive number");
    }
}

TEST(StatedTime, IsNeverAPartOfALongerNumber) {
    EXPECT_EQ(
        said("took 3,5 ms\n", "took ([0-9.]+)"),
        "time: found '3' within a longer number in 'took 3,5 ms', expected a pattern that takes all of it");
    for (const char* line :
         {"took 3.25 ms\n", "took 13.25 ms\n", "took 3,25 ms\n", "took -3 ms\n", "took 1'234 ms\n",
          "took 1\xE2\x80\x99"
          "234 ms\n",
          "took 1\xE2\x80\xAF"
          "234 ms\n",
          "took 1_234 ms\n", "took .5 ms\n", "took 1e-5 ms\n", "took 3-5 ms\n"}) {
        EXPECT_NE(said(line, "([0-9]+) ms").find("within a longer number"), std::string::npos) << line;
    }
    EXPECT_NE(said("took 13.25 ms\n", "took.*([0-9.]+) ms").find("within a longer number"),
              std::string::npos);
    EXPECT_NE(said("took 3e-5\n", "took ([0-9]+)").find("within a longer number"), std::string::npos);
    EXPECT_NE(said("took 3-5\n", "took ([0-9]+)").find("within a longer number"), std::string::npos);
    EXPECT_NE(said("took 31\n", "took ([0-9])").find("within a longer number"), std::string::npos);
    EXPECT_EQ(said("took 3. Done\n", "took ([0-9]+)"), "");
    EXPECT_EQ(said("took 3, which is 4 s\n", "took ([0-9]+)"), "");
    EXPECT_EQ(said("took 3.5 s\n", "took ([0-9]+)\\.[0-9] s"), "") << "the pattern says what follows";
    EXPECT_EQ(said("7,3.5,8\n", "^[0-9]+,([0-9.]+),"), "") << "and here what stands on both sides";
    EXPECT_EQ(said("2 runs: 3elapsed\n", ": ([0-9]+)"), "");
    EXPECT_EQ(said("run-3 ms\n", "([0-9]+) ms"), "");
}

TEST(StatedTime, RefusesWhatTellsNone) {
    EXPECT_EQ(said("a 1\n", "b ([0-9]+)"),
              "time: 'b ([0-9]+)' matches 0 lines of standard output, expected one");
    EXPECT_EQ(said("a x\n", "a (.)"), "time: found 'x', expected a positive number");
    for (const char* number : {"0", "-1", "nan", "inf", "1e999", "1e307 h", "0m0.0s"}) {
        EXPECT_EQ(said(std::string("a ") + number + "\n", "a (.*)"),
                  std::string("time: found '") + number + "', expected a positive number");
    }
    EXPECT_EQ(said("a 1\n", "a ("), "time: found 'a (', expected a regular expression");
    EXPECT_EQ(said("a 1\n", "a 1"), "time: found 'a 1', expected a regular expression with one group");
    EXPECT_EQ(said(std::string(1'000'000, 'a') + "\n", "(a|b)*c"),
              "time: '(a|b)*c' matches 0 lines of standard output, expected one");
}

TEST(StatedTime, RefusesSeveralMatches) {
    EXPECT_EQ(
        said("a 1\na 2\n", "a ([0-9]+)"),
        "time: 'a ([0-9]+)' matches 2 times in standard output, first 'a 1' and last 'a 2', expected once");
    EXPECT_EQ(said("a 1 ms, b 2 ms, c 3 ms\n", "([0-9]+) ms"),
              "time: '([0-9]+) ms' matches 3 times in standard output, first '1 ms' and last '3 ms', "
              "expected once");
    std::string many;
    for (int k = 0; k < 100; ++k) {
        many += "a " + std::to_string(k) + "\n";
    }
    EXPECT_NE(said(many, "a ([0-9]+)").find("matches 100 or more times in standard output"),
              std::string::npos);
}

} // namespace
} // namespace carom
