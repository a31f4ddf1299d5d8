#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/measure/measure.hpp"
#include "harness/measure/profiler.hpp"
#include "harness/measure/timeline.hpp"
#include "harness/support/input_file.hpp"
#include "harness/tests/temporary_directory.hpp"
#include "kernels/tests/scenes.hpp"
#include "variants/registry.hpp"

namespace carom {
namespace {

/// The timeline of a run of 20 steps on `threads` threads, as it reads back from its file.
nlohmann::json timeline_of(int threads, bool chunks, std::int64_t& sweeps) {
    const Scene scene = tests::random_scene(2000, 500, 5, 20, 3, 9);
    const Variant& variant = *find_variant("published");
    const Tuning tuning{.threads = threads};
    Profiler profiler(variant.policies, tuning, {.spans = true, .chunks = chunks});
    const auto simulation = variant.simulate_observed(scene, tuning, profiler);
    sweeps = run_scene(scene, *simulation, tuning, CheckScope::nothing).work.sweeps;
    const tests::TemporaryDirectory directory;
    write_timeline(directory / "timeline", profiler, "a \"title\"");
    return nlohmann::json::parse(read_file(directory / "timeline"));
}

std::map<int, std::vector<nlohmann::json>> tracks_of(const nlohmann::json& timeline) {
    std::map<int, std::vector<nlohmann::json>> tracks;
    for (const auto& event : timeline["traceEvents"]) {
        if (event["ph"] == "X") {
            tracks[event["tid"].get<int>()].push_back(event);
        }
    }
    return tracks;
}

int count_named(const std::vector<nlohmann::json>& events, const std::string& name) {
    int count = 0;
    for (const auto& event : events) {
        count += event["name"] == name;
    }
    return count;
}

/// Each event begins no earlier than the one before and ends within every event it begins in. Times are
/// written to a thousandth of a microsecond.
void expect_nested(const std::vector<nlohmann::json>& events) {
    constexpr double rounding = 0.002;
    std::vector<double> open;
    double last = 0;
    for (const auto& event : events) {
        const double begin = event["ts"];
        const double end = begin + event["dur"].get<double>();
        ASSERT_GE(begin, last);
        last = begin;
        while (!open.empty() && open.back() <= begin + rounding) {
            open.pop_back();
        }
        if (!open.empty()) {
            ASSERT_LE(end, open.back() + rounding) << event;
        }
        open.push_back(end);
    }
}

TEST(Timeline, IsNestedAndMonotonicPerTrack) {
    for (const bool chunks : {false, true}) {
        std::int64_t sweeps = 0;
        const auto tracks = tracks_of(timeline_of(3, chunks, sweeps));
        ASSERT_EQ(tracks.size(), 3U);
        for (const auto& [thread, events] : tracks) {
            expect_nested(events);
        }
    }
}

TEST(Timeline, ShowsPhasesSweepsLoopsAndWaits) {
    std::int64_t sweeps = 0;
    const auto timeline = timeline_of(2, false, sweeps);
    const auto tracks = tracks_of(timeline);
    for (const char* phase : {"move", "bin", "find", "resolve"}) {
        EXPECT_EQ(count_named(tracks.at(0), phase), 20) << phase;
    }
    EXPECT_EQ(count_named(tracks.at(0), "sweep"), sweeps);
    for (const int thread : {0, 1}) {
        EXPECT_LE(count_named(tracks.at(thread), "resolve loop"), 4 * sweeps) << "none where it got no box";
        EXPECT_GT(count_named(tracks.at(thread), "resolve loop"), 0);
        EXPECT_EQ(count_named(tracks.at(thread), "wait"), 4 * sweeps + 20);
        EXPECT_EQ(count_named(tracks.at(thread), "resolve chunk"), 0);
    }
    EXPECT_EQ(timeline["otherData"]["title"], "a \"title\"");
}

TEST(Timeline, ShowsChunksIfAskedFor) {
    std::int64_t sweeps = 0;
    const auto tracks = tracks_of(timeline_of(1, true, sweeps));
    std::int64_t iterations = 0;
    for (const auto& event : tracks.at(0)) {
        if (event["name"] == "find chunk") {
            iterations += event["args"]["count"].get<std::int64_t>();
        }
    }
    const std::int64_t boxes_per_side = 500 / 21;
    EXPECT_EQ(iterations, 20 * boxes_per_side * boxes_per_side);
}

} // namespace
} // namespace carom
