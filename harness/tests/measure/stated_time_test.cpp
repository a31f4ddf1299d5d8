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

std::string report(const Json& benchmarks) { return Json{{"benchmarks", benchmarks}}.dump(); }

TEST(TimeOfBenchmark, IsThatOfTheCaseInItsUnitOverItsRepetitions) {
    const std::string json = report({{{"name", "BM_sort/8"},
                                      {"run_name", "BM_sort/8"},
                                      {"run_type", "iteration"},
                                      {"real_time", 2.0},
                                      {"cpu_time", 1.0},
                                      {"time_unit", "us"},
                                      {"iterations", 10},
                                      {"items_per_second", 5.0}},
                                     {{"name", "BM_sort/8"},
                                      {"run_name", "BM_sort/8"},
                                      {"run_type", "iteration"},
                                      {"real_time", 4.0},
                                      {"cpu_time", 3.0},
                                      {"time_unit", "us"},
                                      {"iterations", 10},
                                      {"items_per_second", 7.0}},
                                     {{"name", "BM_sort/8_mean"},
                                      {"run_name", "BM_sort/8"},
                                      {"run_type", "aggregate"},
                                      {"real_time", 99.0},
                                      {"time_unit", "us"}},
                                     {{"name", "BM_sort/80"}, {"real_time", 77.0}, {"time_unit", "us"}}});
    const StatedTime time = time_of_benchmark(json, "BM_sort/8");
    EXPECT_DOUBLE_EQ(time.seconds, 3e-6);
    EXPECT_DOUBLE_EQ(time.cpu_seconds, 2e-6);
    EXPECT_EQ(time.counters, (std::map<std::string, double>{{"items_per_second", 6.0}}));
}

TEST(TimeOfBenchmark, FindsACaseWhoseNameGoesOn) {
    const std::string json =
        report({{{"name", "BM_sort/8/real_time"}, {"real_time", 2.0}, {"time_unit", "ms"}}});
    EXPECT_DOUBLE_EQ(time_of_benchmark(json, "BM_sort/8").seconds, 2e-3);
}

TEST(TimeOfBenchmark, RefusesNoneSeveralAndFailed) {
    const auto said = [](const std::string& json) {
        return refusal([&] { time_of_benchmark(json, "BM_x"); });
    };
    EXPECT_EQ(said("nonsense"), "benchmark: found no JSON of Google Benchmark, expected what "
                                "--benchmark_out_format=json writes");
    EXPECT_EQ(said(report(Json::array())), "benchmark: 'BM_x' is the name of 0 cases; expected one");
    const Json one{{"name", "BM_x/1"}, {"real_time", 1.0}};
    const Json two{{"name", "BM_x/2"}, {"real_time", 1.0}};
    EXPECT_EQ(said(report({one, two})),
              "benchmark: 'BM_x' is the name of 2 cases: BM_x/1, BM_x/2; expected one");
    EXPECT_EQ(said(report({{{"name", "BM_x"}, {"error_occurred", true}, {"error_message", "no room"}}})),
              "benchmark: BM_x: no room");
    EXPECT_EQ(said(report({{{"name", "BM_x"}}})),
              "benchmark: BM_x: found no time, expected a positive real_time");
}

} // namespace
} // namespace carom
