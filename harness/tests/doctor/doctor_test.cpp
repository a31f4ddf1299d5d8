#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/doctor/findings.hpp"
#include "harness/machine/noise.hpp"
#include "harness/tests/program.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

const Json& findings() {
    static const Json found = examine_machine(0.05);
    return found;
}

/// The text of these findings with every line break and the blanks after it as one blank.
std::string unwrapped(const Json& found) {
    std::istringstream words(doctor_text(found));
    std::string text;
    for (std::string word; words >> word;) {
        text += word + " ";
    }
    return text;
}

void says(const Json& found, const std::string& part) {
    EXPECT_PRED_FORMAT2(testing::IsSubstring, part, unwrapped(found));
}

TEST(Doctor, ThePageFitsOneScreen) {
    const std::string text = doctor_text(findings());
    EXPECT_LE(std::ranges::count(text, '\n'), 45);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(line.size(), 80U) << line;
    }
}

TEST(Doctor, EverySourceCountsOrSaysWhyNot) {
    std::vector<std::string> sources;
    for (const Json& source : findings()["counters"]) {
        sources.push_back(source["source"]);
        EXPECT_GT(source["events"].size() + source["missing"].size(), 0U) << source;
        for (const Json& missing : source["missing"]) {
            EXPECT_NE(missing["reason"], "");
            EXPECT_NE(missing["remedy"], "");
        }
    }
    EXPECT_EQ(sources, (std::vector<std::string>{"papi-hardware", "papi-software", "rusage", "cachegrind"}));
}

TEST(Doctor, WhatCannotBeCountedIsSaidOnceForEachReason) {
    const auto missing = [](const char* event, const char* reason, const char* remedy) {
        return Json{{"event", event}, {"reason", reason}, {"remedy", remedy}};
    };
    Json found = findings();
    found["counters"] =
        Json::array({{{"source", "papi-hardware"},
                      {"events", {"PAPI_TOT_CYC", "PAPI_TOT_INS"}},
                      {"runs", 1},
                      {"missing",
                       {missing("PAPI_A", "unknown", "another PAPI"), missing("PAPI_B", "refused", "ask"),
                        missing("PAPI_C", "unknown", "another PAPI")}}}});
    says(found, "papi-hardware counts PAPI_TOT_CYC, PAPI_TOT_INS, in 1 run ");
    says(found, "papi-hardware cannot count PAPI_A, PAPI_C: unknown; remedy: another PAPI ");
    says(found, "papi-hardware cannot count PAPI_B: refused; remedy: ask ");
}

TEST(Doctor, WhatIsNotKnownIsSaid) {
    Json found = findings();
    for (const char* untold : {"packages", "cores", "smt", "numa_nodes"}) {
        found["topology"][untold] = nullptr;
    }
    found["topology"].update(
        {{"source", "the operating system"}, {"hardware_threads", 8}, {"caches", Json::array()}});
    found["frequency"] = {{"governor", nullptr}, {"turbo", nullptr}};
    found["tools"]["valgrind"] = nullptr;
    found["slurm"] = {{"version", nullptr}, {"job", nullptr}};
    found["noise"]["steal"] = nullptr;
    says(found, "8 hardware threads, SMT not told");
    says(found, "NUMA not told by the operating system; remedy: build with libhwloc-dev");
    says(found, "governor not told, turbo not told");
    says(found, "valgrind not on PATH; remedy: install the package valgrind");
    says(found, "srun not on PATH, not inside a job");
    says(found, "steal time not told");
}

TEST(Doctor, WhatTheSystemTellsIsShown) {
    Json found = findings();
    found["frequency"] = {{"governor", "performance"}, {"turbo", false}};
    found["openmp"]["environment"] = {{"OMP_PLACES", "cores"}, {"OMP_SCHEDULE", "guided,4"}};
    found["slurm"] = {{"version", "slurm 22.05.8"}, {"job", {{"SLURM_JOB_ID", "4711"}}}};
    says(found, "governor performance, turbo off");
    says(found, "OMP_PLACES=cores OMP_SCHEDULE=guided,4");
    says(found, "slurm 22.05.8, inside job 4711");
}

TEST(Doctor, ALimitOfProcessorsIsShownWithTheThreadsThatFollow) {
    Json found = findings();
    Json& affinity = found["affinity"];
    affinity.update({{"affinity", "2-4"},
                     {"affinity_count", 3},
                     {"hardware_threads", 8},
                     {"cpu_quota", 1.5},
                     {"usable_processors", 1},
                     {"threads_by_default", 1}});
    says(found, "affinity 3 CPUs: 2-4, of 8 hardware threads ");
    says(found, "CPU quota time of 1.5 processors in all (cgroup)");
    says(found, "threads Carom takes 1 thread by default, on 1 usable processor ");
    affinity.update({{"cpu_quota", nullptr}, {"hardware_threads", 3}, {"has_unread_cpu_quota", false}});
    EXPECT_EQ(unwrapped(found).find("CPU quota"), std::string::npos);
    EXPECT_EQ(unwrapped(found).find("2-4, of"), std::string::npos);
    affinity["has_unread_cpu_quota"] = true;
    says(found, "CPU quota cannot be read: control groups of version 1");
}

TEST(Doctor, TellsAloneHowTheProgramWasBuilt) {
    const auto result = tests::run_carom({"doctor", "--build"});
    EXPECT_EQ(result.exit_code, 0);
    const Json told = Json::parse(result.output);
    const Json& json = findings();
    for (const auto& [field, value] : json["program"].items()) {
        EXPECT_EQ(told[field], value) << field;
    }
    EXPECT_EQ(told["openmp"]["runtime"], json["openmp"]["runtime"]);
}

TEST(Doctor, TheProgramPrintsNothingElse) {
    const auto result = tests::run_carom({"doctor", "--json"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.error, "");
    const Json json = Json::parse(result.output, nullptr, false);
    ASSERT_TRUE(json.is_object()) << result.output;
    for (const auto& [key, value] : findings().items()) {
        EXPECT_TRUE(json.contains(key)) << key;
    }
    EXPECT_GT(json["noise"]["spins"], 10);
}

TEST(Noise, IsTheSpreadOfTheDurations) {
    std::vector<double> durations;
    for (int k = 1; k <= 100; ++k) {
        durations.push_back(k * 1e-3);
    }
    std::ranges::reverse(durations);
    const Noise noise = spread(durations);
    EXPECT_EQ(noise.spins, 100);
    EXPECT_DOUBLE_EQ(noise.median_seconds, 0.050);
    EXPECT_DOUBLE_EQ(noise.p95_over_median, 95.0 / 50);
    EXPECT_DOUBLE_EQ(noise.max_over_median, 100.0 / 50);
}

TEST(Noise, OfNeighboursIsThatOfStretchesOfALength) {
    std::vector<double> durations;
    for (int k = 0; k < 400; ++k) {
        // Every other stretch of ten is a tenth longer.
        durations.push_back((k / 10) % 2 == 0 ? 1e-3 : 1.1e-3);
    }
    const auto found = neighbours(durations);
    ASSERT_EQ(found.size(), 4) << "of 1, 2, 5 and 10: of 20 there are too few";
    EXPECT_EQ(found[0].difference, 0);
    EXPECT_EQ(found[3].seconds, 0.01);
    EXPECT_NEAR(found[3].difference, std::log(1.1) / 0.6745, 1e-9);
    Noise noise;
    noise.neighbours = found;
    EXPECT_NE(noise_figure(noise).find("   10 ms               14.13 %                       1.413 %   ####"),
              std::string::npos)
        << noise_figure(noise);
}

TEST(Noise, OfOneSpinIsNone) {
    const Noise noise = spread({0.25});
    EXPECT_EQ(noise.p95_over_median, 1);
    EXPECT_EQ(noise.max_over_median, 1);
}

TEST(Noise, StolenTimeIsTheEighthFieldOfTheFirstLine) {
    const auto time = parse_cpu_time("cpu  10 20 30 40 50 60 70 80 5 6");
    ASSERT_TRUE(time);
    EXPECT_EQ(time->total, 360);
    EXPECT_EQ(time->stolen, 80);
    EXPECT_FALSE(parse_cpu_time("cpu0 10 20 30 40 50 60 70 80 5 6"));
    EXPECT_FALSE(parse_cpu_time("cpu 10 20 30"));
    EXPECT_FALSE(parse_cpu_time(""));
}

} // namespace
} // namespace carom
