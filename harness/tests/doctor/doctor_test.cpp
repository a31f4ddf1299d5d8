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

const Findings& findings() {
    static const Findings found = examine_machine(0.05);
    return found;
}

/// The text of these findings with every line break and the blanks after it as one blank.
std::string unwrapped(const Findings& found) {
    std::istringstream words(doctor_text(found));
    std::string text;
    for (std::string word; words >> word;) {
        text += word + " ";
    }
    return text;
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
    const Json json = doctor_json(findings());
    for (const Json& source : json["counters"]) {
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
        return CounterValue{event, {}, {}, "papi-hardware", reason, remedy};
    };
    Findings found = findings();
    found.counters = {
        {.name = "papi-hardware",
         .events = {"PAPI_TOT_CYC", "PAPI_TOT_INS"},
         .runs = 1,
         .missing = {missing("PAPI_A", "unknown", "another PAPI"), missing("PAPI_B", "refused", "ask"),
                     missing("PAPI_C", "unknown", "another PAPI")}}};
    const std::string text = unwrapped(found);
    EXPECT_NE(text.find("papi-hardware counts PAPI_TOT_CYC, PAPI_TOT_INS, in 1 run "), std::string::npos)
        << text;
    EXPECT_NE(text.find("papi-hardware cannot count PAPI_A, PAPI_C: unknown; remedy: another PAPI "),
              std::string::npos);
    EXPECT_NE(text.find("papi-hardware cannot count PAPI_B: refused; remedy: ask "), std::string::npos);
}

TEST(Doctor, WhatIsNotKnownIsSaid) {
    Findings found = findings();
    found.topology = {.source = "the operating system",
                      .packages = {},
                      .cores = {},
                      .hardware_threads = 8,
                      .numa_nodes = {},
                      .caches = {}};
    found.machine.governor = {};
    found.turbo = {};
    std::ranges::find(found.tools, "valgrind", &Tool::name)->version = {};
    found.slurm_version = {};
    found.slurm_job = {};
    found.noise.steal = {};
    const std::string text = unwrapped(found);
    EXPECT_NE(text.find("8 hardware threads, SMT not told"), std::string::npos) << text;
    EXPECT_NE(text.find("NUMA not told by the operating system; remedy: build with libhwloc-dev"),
              std::string::npos);
    EXPECT_NE(text.find("governor not told, turbo not told"), std::string::npos);
    EXPECT_NE(text.find("valgrind not on PATH; remedy: install the package valgrind"), std::string::npos);
    EXPECT_NE(text.find("srun not on PATH, not inside a job"), std::string::npos);
    EXPECT_NE(text.find("steal time not told"), std::string::npos);
    const Json json = doctor_json(found);
    EXPECT_EQ(json["topology"]["smt"], nullptr);
    EXPECT_EQ(json["topology"]["caches"], Json::array());
    EXPECT_EQ(json["frequency"], (Json{{"governor", nullptr}, {"turbo", nullptr}}));
    EXPECT_EQ(json["tools"]["valgrind"], nullptr);
    EXPECT_EQ(json["slurm"], (Json{{"version", nullptr}, {"job", nullptr}}));
    EXPECT_EQ(json["noise"]["steal"], nullptr);
}

TEST(Doctor, WhatTheSystemTellsIsShown) {
    Findings found = findings();
    found.machine.governor = "performance";
    found.turbo = false;
    found.openmp.environment = {{"OMP_PLACES", "cores"}, {"OMP_SCHEDULE", "guided,4"}};
    found.slurm_version = "slurm 22.05.8";
    found.slurm_job = {{"SLURM_JOB_ID", "4711"}};
    const std::string text = unwrapped(found);
    EXPECT_NE(text.find("governor performance, turbo off"), std::string::npos) << text;
    EXPECT_NE(text.find("OMP_PLACES=cores OMP_SCHEDULE=guided,4"), std::string::npos);
    EXPECT_NE(text.find("slurm 22.05.8, inside job 4711"), std::string::npos);
    const Json json = doctor_json(found);
    EXPECT_EQ(json["frequency"], (Json{{"governor", "performance"}, {"turbo", false}}));
    EXPECT_EQ(json["slurm"]["job"], (Json{{"SLURM_JOB_ID", "4711"}}));
}

TEST(Doctor, ALimitOfProcessorsIsShownWithTheThreadsThatFollow) {
    Findings found = findings();
    Machine& machine = found.machine;
    machine.affinity = "2-4";
    machine.affinity_count = 3;
    machine.hardware_threads = 8;
    machine.cpu_quota = 1.5;
    found.usable_processors = 1;
    found.threads_by_default = 1;
    const std::string text = unwrapped(found);
    EXPECT_NE(text.find("affinity 3 CPUs: 2-4, of 8 hardware threads "), std::string::npos) << text;
    EXPECT_NE(text.find("CPU quota time of 1.5 processors in all (cgroup)"), std::string::npos) << text;
    EXPECT_NE(text.find("threads Carom takes 1 thread by default, on 1 usable processor "), std::string::npos)
        << text;
    machine.cpu_quota = {};
    machine.hardware_threads = 3;
    machine.has_unread_cpu_quota = false;
    EXPECT_EQ(unwrapped(found).find("CPU quota"), std::string::npos);
    machine.has_unread_cpu_quota = true;
    EXPECT_NE(unwrapped(found).find("CPU quota cannot be read: control groups of version 1"),
              std::string::npos);
    EXPECT_EQ(unwrapped(found).find("2-4, of"), std::string::npos);
}

TEST(Doctor, TellsAloneHowTheProgramWasBuilt) {
    const auto result = tests::run_carom({"doctor", "--build"});
    EXPECT_EQ(result.exit_code, 0);
    const Json told = Json::parse(result.output);
    const Json json = doctor_json(findings());
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
    const Json found = doctor_json(findings());
    for (const auto& [key, value] : found.items()) {
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

TEST(Noise, IsMeasuredOnThisMachine) {
    const Noise noise = measure_noise(0.05);
    EXPECT_GT(noise.spins, 0);
    EXPECT_GT(noise.median_seconds, 0);
    EXPECT_GE(noise.p95_over_median, 1);
    EXPECT_GE(noise.max_over_median, noise.p95_over_median);
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
