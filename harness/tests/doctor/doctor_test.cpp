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

TEST(Doctor, TellsWhatIsKnownAndWhatIsNot) {
    struct Case {
        const char* found;
        std::vector<std::string> says;
    };
    const std::vector<Case> cases{
        {R"({"counters": [{"source": "papi-hardware", "events": ["PAPI_TOT_CYC", "PAPI_TOT_INS"], "runs": 1,
                           "missing": [{"event": "PAPI_A", "reason": "unknown", "remedy": "another PAPI"},
                                       {"event": "PAPI_B", "reason": "refused", "remedy": "ask"},
                                       {"event": "PAPI_C", "reason": "unknown", "remedy": "another PAPI"}]}]})",
         {"papi-hardware counts PAPI_TOT_CYC, PAPI_TOT_INS, in 1 run ",
          "papi-hardware cannot count PAPI_A, PAPI_C: unknown; remedy: another PAPI ",
          "papi-hardware cannot count PAPI_B: refused; remedy: ask "}},
        {R"({"topology": {"source": "the operating system", "packages": null, "cores": null, "smt": null,
                          "numa_nodes": null, "hardware_threads": 8, "caches": []}})",
         {"8 hardware threads, SMT not told",
          "NUMA not told by the operating system; remedy: build with libhwloc-dev"}},
        {R"({"frequency": {"governor": null, "turbo": null}, "tools": {"valgrind": null},
             "slurm": {"version": null, "job": null}, "noise": {"steal": null}})",
         {"governor not told, turbo not told", "valgrind not on PATH; remedy: install the package valgrind",
          "srun not on PATH, not inside a job", "steal time not told"}},
        {R"({"frequency": {"governor": "performance", "turbo": false},
             "openmp": {"environment": {"OMP_PLACES": "cores", "OMP_SCHEDULE": "guided,4"}},
             "slurm": {"version": "slurm 22.05.8", "job": {"SLURM_JOB_ID": "4711"}}})",
         {"governor performance, turbo off", "OMP_PLACES=cores OMP_SCHEDULE=guided,4",
          "slurm 22.05.8, inside job 4711"}},
        {R"({"affinity": {"affinity": "2-4", "affinity_count": 3, "hardware_threads": 8, "cpu_quota": 1.5,
                          "usable_processors": 1, "threads_by_default": 1}})",
         {"affinity 3 CPUs: 2-4, of 8 hardware threads CPU quota time of 1.5 processors in all (cgroup)",
          "threads Carom takes 1 thread by default, on 1 usable processor "}},
        {R"({"affinity": {"affinity": "2-4", "affinity_count": 3, "hardware_threads": 3, "cpu_quota": null}})",
         {"affinity 3 CPUs: 2-4 threads Carom takes "}}};
    for (const Case& one : cases) {
        Json found = findings();
        found.update(Json::parse(one.found), true);
        std::istringstream words(doctor_text(found));
        std::string unwrapped;
        for (std::string word; words >> word;) {
            unwrapped += word + " ";
        }
        for (const std::string& said : one.says) {
            EXPECT_PRED_FORMAT2(testing::IsSubstring, said, unwrapped);
        }
    }
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
