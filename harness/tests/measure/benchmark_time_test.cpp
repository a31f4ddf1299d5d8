#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/measure/stated_time.hpp"
#include "harness/support/errors.hpp"

namespace carom {
namespace {

using Json = nlohmann::json;
using Counters = std::map<std::string, std::optional<double>>;

std::string why_refused(const std::string& json, const std::string& name = "BM_x") {
    try {
        time_of_benchmark(json, name);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::string report(const Json& benchmarks) { return Json{{"benchmarks", benchmarks}}.dump(); }

/// A report of one run of BM_x, of which these are further fields, as text.
std::string run_with(const std::string& fields) {
    return R"({"benchmarks": [{"name": "BM_x", "run_name": "BM_x", "run_type": "iteration", )" + fields +
           "}]}";
}

Json repetition(int number, double time, int family = 0) {
    return {{"name", "BM_x"},         {"run_name", "BM_x"},         {"run_type", "iteration"},
            {"family_index", family}, {"repetition_index", number}, {"per_family_instance_index", 0},
            {"real_time", time}};
}

Json aggregate(const std::string& name, double time, int family = 0) {
    return {
        {"name", "BM_x_" + name}, {"run_name", "BM_x"}, {"run_type", "aggregate"}, {"aggregate_name", name},
        {"family_index", family}, {"iterations", 3},    {"real_time", time},       {"rate", 7.0}};
}

TEST(TimeOfBenchmark, IsThatOfTheCaseInItsUnitOverItsRepetitions) {
    Json first = repetition(0, 2.0);
    first.update({{"cpu_time", 1.0}, {"time_unit", "us"}, {"iterations", 10}, {"items_per_second", 5.0}});
    Json second = repetition(1, 4.0);
    second.update({{"cpu_time", 3.0}, {"time_unit", "us"}, {"iterations", 10}, {"items_per_second", 7.0}});
    const Json other{{"name", "BM_x0"}, {"real_time", 77.0}, {"time_unit", "us"}};
    const StatedTime time = time_of_benchmark(report({first, second, aggregate("mean", 99), other}), "BM_x");
    EXPECT_DOUBLE_EQ(time.seconds, 3e-6);
    EXPECT_DOUBLE_EQ(time.cpu_seconds, 2e-6);
    EXPECT_EQ(time.counters, (Counters{{"items_per_second", 6.0}}));
    EXPECT_EQ(time.threads, 1);
    EXPECT_FALSE(time.library_version);
}

TEST(TimeOfBenchmark, KnowsEveryUnit) {
    const std::map<std::string, double> units{{"ns", 2e-9}, {"us", 2e-6}, {"ms", 2e-3}, {"s", 2.0}};
    for (const auto& [unit, seconds] : units) {
        const std::string json = run_with(R"("real_time": 2, "time_unit": ")" + unit + "\"");
        EXPECT_DOUBLE_EQ(time_of_benchmark(json, "BM_x").seconds, seconds);
    }
    EXPECT_EQ(why_refused(run_with(R"("real_time": 2, "time_unit": "h")")),
              "benchmark: BM_x: found time_unit 'h', expected ns, us, ms or s");
}

TEST(TimeOfBenchmark, FindsACaseWhoseNameGoesOn) {
    const std::string json =
        report({{{"name", "BM_sort/8/real_time"}, {"real_time", 2.0}, {"time_unit", "ms"}}});
    EXPECT_DOUBLE_EQ(time_of_benchmark(json, "BM_sort/8").seconds, 2e-3);
}

TEST(TimeOfBenchmark, ReadsCountersThatAreNoNumbers) {
    const StatedTime time = time_of_benchmark(
        run_with(
            R"("real_time": 5, "a": NaN, "b": Infinity, "c":-Infinity, "f": 1.5, "label": "NaN, Infinity \" NaN", "g": NaN)"),
        "BM_x");
    EXPECT_DOUBLE_EQ(time.seconds, 5e-9);
    EXPECT_EQ(time.counters, (Counters{{"a", {}}, {"b", {}}, {"c", {}}, {"f", 1.5}, {"g", {}}}));
}

TEST(TimeOfBenchmark, HasNoMeanOfACounterThatIsNoNumberInEveryRepetition) {
    const std::string json = R"({"benchmarks": [
        {"name": "BM_x", "family_index": 0, "repetition_index": 0, "real_time": 1, "a": NaN, "b": 1, "c": 1},
        {"name": "BM_x", "family_index": 0, "repetition_index": 1, "real_time": 3, "a": 1, "b": 2}]})";
    const StatedTime time = time_of_benchmark(json, "BM_x");
    EXPECT_DOUBLE_EQ(time.seconds, 2e-9);
    EXPECT_EQ(time.counters, (Counters{{"a", {}}, {"b", 1.5}, {"c", {}}}));
}

TEST(TimeOfBenchmark, IsNotThatOfACounterNamedAsAField) {
    const std::string json =
        run_with(R"("real_time": 5, "time_unit": "us", "skipped": 3, "real_time": 9, "time_unit": 2)");
    const StatedTime time = time_of_benchmark(json, "BM_x");
    EXPECT_DOUBLE_EQ(time.seconds, 5e-6);
    EXPECT_EQ(time.counters, (Counters{{"skipped", 3.0}}));
}

TEST(TimeOfBenchmark, RefusesTwoCasesOfOneName) {
    const std::string refused =
        "benchmark: 'BM_x' is the name of several cases; expected one, each registered by a name of its own";
    EXPECT_EQ(why_refused(report({repetition(0, 1, 0), repetition(0, 9, 1)})), refused);
    EXPECT_EQ(why_refused(report({repetition(0, 1, 0), repetition(1, 9, 1)})), refused);
    EXPECT_EQ(why_refused(report({repetition(0, 1), repetition(0, 9)})), refused);
    Json instance = repetition(1, 9);
    instance["per_family_instance_index"] = 1;
    EXPECT_EQ(why_refused(report({repetition(0, 1), instance})), refused);
    EXPECT_EQ(why_refused(report({aggregate("mean", 1, 0), aggregate("mean", 9, 1)})), refused);
    const Json plain{{"name", "BM_x"}, {"real_time", 1.0}};
    const Json other{{"name", "BM_y"}, {"real_time", 1.0}};
    EXPECT_EQ(why_refused(report({plain, plain})), refused);
    EXPECT_EQ(why_refused(report({plain, other, plain})), refused);
}

TEST(TimeOfBenchmark, TakesTheMeanWhereThereAreOnlyAggregates) {
    const StatedTime time = time_of_benchmark(
        report({aggregate("mean", 5), aggregate("median", 4), aggregate("stddev", 1)}), "BM_x");
    EXPECT_DOUBLE_EQ(time.seconds, 5e-9);
    EXPECT_EQ(time.counters, (Counters{{"rate", 7.0}}));
    EXPECT_EQ(why_refused(report({aggregate("median", 4), aggregate("cv", 1)})),
              "benchmark: BM_x: found only aggregates (median, cv), expected runs or their mean");
    EXPECT_EQ(why_refused(report({aggregate("BigO", 4), aggregate("RMS", 1)})),
              "benchmark: 'BM_x' is the name of 0 cases; expected one");
}

TEST(TimeOfBenchmark, RefusesWhatFailedOrWasSkippedByItsMessage) {
    EXPECT_EQ(why_refused(run_with(R"("error_occurred": true, "error_message": "no\nroom", "real_time": 1)")),
              "benchmark: BM_x: failed: no?room");
    EXPECT_EQ(why_refused(run_with(R"("skipped": true, "skip_message": "no GPU", "iterations": 0)")),
              "benchmark: BM_x: was skipped: no GPU");
    EXPECT_EQ(why_refused(run_with(R"("skipped": true, "skip_message": "", "real_time": 0)")),
              "benchmark: BM_x: was skipped without a word");
    EXPECT_EQ(why_refused(run_with(R"("error_occurred": true, "error_message": 5)")),
              "benchmark: BM_x: failed without a word");
    EXPECT_EQ(why_refused(run_with(R"("real_time": 1, "error_occurred": false, "skipped": false)")), "");
    Json failed = repetition(1, 0);
    failed["error_occurred"] = true;
    EXPECT_EQ(why_refused(report({repetition(0, 1), failed})), "benchmark: BM_x: failed without a word");
}

TEST(TimeOfBenchmark, RefusesWhatIsNoTime) {
    const auto said = [](const std::string& fields) { return why_refused(run_with(fields)); };
    EXPECT_EQ(said(R"("iterations": 5)"), "benchmark: BM_x: found no real_time, expected a positive number");
    EXPECT_EQ(said(R"("real_time": NaN)"),
              "benchmark: BM_x: found real_time NaN, expected a positive number");
    EXPECT_EQ(said(R"("real_time": Infinity)"),
              "benchmark: BM_x: found real_time Infinity, expected a positive number");
    EXPECT_EQ(said(R"("real_time": 0)"), "benchmark: BM_x: found real_time '0', expected a positive number");
    EXPECT_EQ(said(R"("real_time": -1)"),
              "benchmark: BM_x: found real_time '-1', expected a positive number");
    EXPECT_EQ(said(R"("real_time": "5")"),
              "benchmark: BM_x: found real_time '\"5\"', expected a positive number");
    EXPECT_EQ(said(R"("real_time": null)"),
              "benchmark: BM_x: found real_time 'null', expected a positive number");
    EXPECT_EQ(said(R"("iterations": 0, "real_time": 5)"),
              "benchmark: BM_x: found iterations 0, expected one at least");
}

TEST(TimeOfBenchmark, RefusesNoneAndSeveral) {
    EXPECT_EQ(why_refused(report(Json::array())), "benchmark: 'BM_x' is the name of 0 cases; expected one");
    const Json one{{"name", "BM_x/1"}, {"real_time", 1.0}};
    const Json two{{"name", "BM_x/2"}, {"real_time", 1.0}};
    EXPECT_EQ(why_refused(report({one, two})),
              "benchmark: 'BM_x' is the name of 2 cases: BM_x/1, BM_x/2; expected one");
    Json many = Json::array();
    for (int k = 0; k < 20; ++k) {
        many.push_back({{"name", "BM_x/" + std::to_string(100 + k)}, {"real_time", 1.0}});
    }
    const std::string said = why_refused(report(many));
    EXPECT_NE(said.find("BM_x/107, ...; expected one"), std::string::npos) << said;
}

TEST(TimeOfBenchmark, SaysWhatStandsInThePlaceOfAReport) {
    const std::string expected = ", expected what --benchmark_out_format=json writes";
    const auto said = [](const std::string& text) { return why_refused(text); };
    EXPECT_EQ(said(""), "benchmark: found an empty file" + expected);
    EXPECT_EQ(said(" \n\t\n"), "benchmark: found nothing but blanks" + expected);
    EXPECT_EQ(said("Segmentation fault\n"),
              "benchmark: found no JSON of Google Benchmark but 'Segmentation fault'" + expected);
    const std::string json = run_with(R"("real_time": 5)");
    EXPECT_EQ(said("loading\n" + json),
              "benchmark: found no JSON of Google Benchmark but 'loading'" + expected);
    EXPECT_EQ(said(json + "\ndone\n"), "benchmark: found no JSON in line 2: 'done'" + expected);
    EXPECT_EQ(said("{}"), "benchmark: found JSON without a list `benchmarks`" + expected);
    EXPECT_EQ(said(R"({"benchmarks": 5})"), "benchmark: found JSON without a list `benchmarks`" + expected);
    EXPECT_EQ(said(R"({"benchmarks": [5]})"),
              "benchmark: found something in the list `benchmarks` that is no object" + expected);
    EXPECT_EQ(said(R"({"benchmarks": [{"real_time": 1e999}]})"),
              "benchmark: found a number that is too large" + expected);
}

TEST(TimeOfBenchmark, NamesTheLocaleWhoseNumbersAreNoJson) {
    const auto names = [](const std::string& number) {
        const std::string said =
            why_refused("{\"context\": {\"num_cpus\": 4,\n\"mhz_per_cpu\": " + number + ",\n\"x\": 1}}");
        return said.find("no JSON in line 2: '") != std::string::npos &&
               said.find(
                   "' (numbers in the form of a locale; with LC_ALL=C in its environment they are plain), "
                   "expected ") != std::string::npos;
    };
    for (const char* number : {"2,5", "2,000", "1,2345678901234567e+02", "1.234,5", "1.234.567", "1'234",
                               "1\xE2\x80\x99"
                               "234",
                               "1\xC2\xA0"
                               "234",
                               "1\xE2\x80\xAF"
                               "234",
                               "1\xA0"
                               "234"}) {
        EXPECT_TRUE(names(number)) << number;
    }
    for (const char* number : {"2 5", "x", "2.5e", "[1,2"}) {
        EXPECT_FALSE(names(number)) << number;
    }
}

TEST(TimeOfBenchmark, SaysWhereAReportBreaksOff) {
    const std::string json = run_with(R"("real_time": 5.25, "rate": NaN, "label": "half")");
    ASSERT_EQ(why_refused(json), "");
    for (std::size_t length = 1; length < json.size(); ++length) {
        const std::string said = why_refused(json.substr(0, length));
        EXPECT_TRUE(said.starts_with("benchmark: found JSON that breaks off after '") ||
                    said.starts_with("benchmark: found no JSON in line 1: '"))
            << said;
        EXPECT_TRUE(said.ends_with(", expected what --benchmark_out_format=json writes")) << said;
        EXPECT_EQ(said.find('\n'), std::string::npos);
    }
}

TEST(TimeOfBenchmark, ReadsNamesOfAnyCharacters) {
    const std::string name = "BM_<\"a\\b\">/größe/ 7";
    const std::string json = report({{{"name", name}, {"real_time", 2.0}}});
    EXPECT_DOUBLE_EQ(time_of_benchmark(json, name).seconds, 2e-9);
    const std::string raw =
        R"({"benchmarks": [{"name": "BM_)" + std::string("\xff\xc3\x1b\t") + R"(", "real_time": 2}]})";
    EXPECT_DOUBLE_EQ(time_of_benchmark(raw, "BM_\xEF\xBF\xBD\xEF\xBF\xBD\x1b\t").seconds, 2e-9);
    EXPECT_DOUBLE_EQ(
        time_of_benchmark(run_with("\"real_time\": 2, \"label\": \"\xf0\x28\x8c\x28 \xed\xa0\x80\""), "BM_x")
            .seconds,
        2e-9);
    EXPECT_EQ(why_refused(raw, "BM\n"), "benchmark: 'BM?' is the name of 0 cases; expected one");
}

TEST(TimeOfBenchmark, TellsThreadsAndVersion) {
    const auto of = [](const std::string& context, const std::string& run) {
        return time_of_benchmark(
            R"({"context": )" + context + R"(, "benchmarks": [{"real_time": 5, )" + run + "}]}", "a");
    };
    const StatedTime time = of(R"({"library_version": "v1.8.3"})", R"("name": "a", "threads": 4)");
    EXPECT_EQ(time.threads, 4);
    EXPECT_EQ(time.library_version, "v1.8.3");
    EXPECT_FALSE(of("{}", R"("name": "a")").library_version);
    EXPECT_FALSE(of("[]", R"("name": "a")").library_version);
    EXPECT_EQ(of(R"({"library_version": ""})", R"("name": "a")").library_version, "");
}

StatedTime stated(const std::optional<std::string>& version, int threads) {
    StatedTime time;
    time.library_version = version;
    time.threads = threads;
    return time;
}

TEST(UnlikeTimes, AreThoseOfVersionsThatMeanOtherThings) {
    EXPECT_EQ(
        unlike_times(stated("v1.8.3", 4), stated("v1.9.1", 4)),
        "Google Benchmark 'v1.8.3' beside 'v1.9.1': of a case on several threads they do not mean the same "
        "by real_time (before 1.9 it is divided by the number of threads); build both with one version");
    EXPECT_TRUE(unlike_times(stated({}, 2), stated("v1.9.5", 2)));
    EXPECT_TRUE(unlike_times(stated("v1.9.4", 1), stated("v1.7.1", 2)));
    EXPECT_TRUE(unlike_times(stated("v2.0.0", 2), stated("v1.8.5", 2)));
}

TEST(UnlikeTimes, AreThoseOfWhichNobodyKnows) {
    for (const char* version :
         {"", "v0.0.0", "main", "v1.9.0", "v1.9.0-12-gabcdef0", "v1.8.5-30-gabcdef0", "v1.9"}) {
        EXPECT_TRUE(unlike_times(stated(version, 2), stated("v1.9.1", 2))) << version;
        EXPECT_TRUE(unlike_times(stated(version, 2), stated("v1.8.3", 2))) << version;
        EXPECT_FALSE(unlike_times(stated(version, 2), stated(version, 2))) << version;
    }
}

TEST(UnlikeTimes, AreNoneOfOneThreadOrOneMeaning) {
    EXPECT_FALSE(unlike_times(stated("v1.8.3", 1), stated("v1.9.1", 1)));
    EXPECT_FALSE(unlike_times(stated("v1.8.3", 4), stated("v1.7.1", 4)));
    EXPECT_FALSE(unlike_times(stated("v1.8.3", 4), stated({}, 4)));
    EXPECT_FALSE(unlike_times(stated("v1.9.1", 4), stated("v1.9.4-2-gabcdef0", 4)));
    EXPECT_FALSE(unlike_times(stated("v1.9.1", 4), stated("1.10.0", 4)));
}

} // namespace
} // namespace carom
