#include "harness/commands/profile_table.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "harness/measure/timeline.hpp"
#include "harness/support/format.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

/// Load imbalance: the busiest thread's time over the mean.
double imbalance(const Profiler& profiler, Phase phase) {
    double most = 0;
    double sum = 0;
    for (int thread = 0; thread < profiler.threads(); ++thread) {
        const double busy = profiler.work(phase, thread).busy_seconds;
        most = std::max(most, busy);
        sum += busy;
    }
    return sum > 0 ? most * profiler.threads() / sum : 1;
}

void print_phases(const Profile& profile) {
    double serial = 0;
    std::printf("\n%-8s %10s %7s %10s %10s\n", "phase", "wall s", "share", "serial s", "imbalance");
    for (const Phase phase : all_phases) {
        const PhaseTime& time = profile.profiler.phase_time(phase);
        serial += time.serial_seconds;
        std::printf("%-8s %10.4f %6.1f%% %10.4f %10.2f\n", std::string(word(phase)).c_str(),
                    time.wall_seconds, 100 * time.wall_seconds / profile.wall_seconds, time.serial_seconds,
                    imbalance(profile.profiler, phase));
    }
    std::printf("%-8s %10.4f         %10.4f   (serial share %.1f%%)\n", "whole", profile.wall_seconds, serial,
                100 * serial / profile.wall_seconds);
}

void print_threads(const Profile& profile) {
    std::printf("\n%-8s %6s %10s %10s %12s %10s %8s\n", "phase", "thread", "busy s", "waiting s",
                "iterations", "chunks", "loops");
    for (const Phase phase : all_phases) {
        for (int thread = 0; thread < profile.profiler.threads(); ++thread) {
            const ThreadWork& work = profile.profiler.work(phase, thread);
            std::printf("%-8s %6d %10.4f %10.4f %12lld %10lld %8lld\n", std::string(word(phase)).c_str(),
                        thread, work.busy_seconds, work.waiting_seconds,
                        static_cast<long long>(work.iterations), static_cast<long long>(work.chunks),
                        static_cast<long long>(work.loops));
        }
    }
}

void print_counters(const Profile& profile) {
    std::map<std::pair<std::string, std::string>, std::string> missing;
    std::printf("\n%-30s %6s %18s  %s\n", "counter", "thread", "value", "source");
    for (const CounterValue& counter : profile.counters) {
        if (!counter.value) {
            std::string& names = missing[{counter.source + ": " + counter.reason, counter.remedy}];
            names += (names.empty() ? "" : ", ") + counter.name;
            continue;
        }
        const std::string thread = counter.thread ? std::to_string(*counter.thread) : "all";
        std::printf("%-30s %6s %18.10g  %s\n", counter.name.c_str(), thread.c_str(), *counter.value,
                    counter.source.c_str());
    }
    for (const auto& [why, names] : missing) {
        std::printf("not counted: %s\n  because %s\n  remedy: %s\n", names.c_str(), why.first.c_str(),
                    why.second.c_str());
    }
}

} // namespace

std::string cost_text(double cost) {
    constexpr double least_credible = 0.97;
    return format("profiling cost: the profiled run took %.3f of the bare run's time", cost) +
           (cost < least_credible ? "; as looking on saves nothing, something else slowed the bare run" : "");
}

void print_profile(const Profile& profile, const Measurement& measurement) {
    std::printf("%s: %s, %s, variant %s, %s, %s\n", measurement.scene_name.c_str(),
                counted(measurement.scene.discs.size(), "disc").c_str(),
                counted(std::int64_t{measurement.scene.steps} * measurement.tuning.substeps, "step").c_str(),
                std::string(measurement.variant.name).c_str(),
                counted(measurement.tuning.threads, "thread").c_str(),
                counted(profile.sweeps, "sweep").c_str());
    std::printf("%s\n", cost_text(profile.cost).c_str());
    print_phases(profile);
    print_threads(profile);
    print_counters(profile);
    if (profile.profiler.spans_left_out() > 0) {
        std::printf("the timeline leaves out its last %zu spans, to stay small enough to open\n",
                    profile.profiler.spans_left_out());
    }
}

} // namespace carom
