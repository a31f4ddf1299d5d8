#include "harness/counters/counters.hpp"

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <sstream>

#include "harness/counters/access.hpp"
#include "harness/counters/groups.hpp"
#include "harness/counters/on_threads.hpp"
#include "harness/counters/papi.hpp"
#include "harness/counters/rusage.hpp"

namespace carom {
namespace {

/// What is counted if nobody says otherwise: presets where PAPI has them for this CPU, otherwise the kernel's
/// own generic events.
std::vector<Alternatives> default_counters() {
    return {{"PAPI_TOT_CYC", "perf::CYCLES"},
            {"PAPI_TOT_INS", "perf::INSTRUCTIONS"},
            {"PAPI_L1_DCM", "perf::L1-DCACHE-LOAD-MISSES"},
            {"PAPI_L2_TCM", "PAPI_L2_DCM"},
            {"PAPI_L3_TCM", "perf::CACHE-MISSES"},
            {"PAPI_BR_MSP", "perf::BRANCH-MISSES"},
            {"PAPI_TLB_DM", "perf::DTLB-LOAD-MISSES"},
            {"PAPI_RES_STL", "perf::STALLED-CYCLES-BACKEND"},
            {"perf::TASK-CLOCK"},
            {"perf::CONTEXT-SWITCHES"},
            {"perf::CPU-MIGRATIONS"},
            {"perf::PAGE-FAULTS"}};
}

std::vector<std::string> events_of_environment() {
    std::vector<std::string> events;
    const char* text = std::getenv("PAPI_EVENTS");
    std::istringstream list(text == nullptr ? "" : text);
    for (std::string event; std::getline(list, event, ',');) {
        std::erase_if(event, [](char letter) { return letter == ' ' || letter == '\t'; });
        if (!event.empty()) {
            events.push_back(event);
        }
    }
    return events;
}

std::vector<Alternatives> wanted_events(std::vector<std::string> events) {
    if (events.empty()) {
        events = events_of_environment();
    }
    if (events.empty()) {
        return default_counters();
    }
    std::vector<Alternatives> wanted;
    for (const std::string& event : events) {
        if (std::ranges::find(wanted, Alternatives{event}) == wanted.end()) {
            wanted.push_back({event});
        }
    }
    return wanted;
}

/// Why an event cannot be counted. That there is none of that name is not the machine's fault.
Explanation why_missing(const PerfAccess& access, const std::string& source, const Uncountable& missing) {
    if (!knows_event(missing.event)) {
        return {"PAPI " + papi_version() + " knows no event of that name on this machine",
                "a name from `papi_avail` or `papi_native_avail`"};
    }
    return explain(access, source, missing.error);
}

void plan_source(const std::string& source, const std::vector<Alternatives>& wanted, const MakeEventSet& make,
                 CounterPlan& plan) {
    const EventGroups found = group_events(wanted, make);
    for (const auto& events : found.groups) {
        plan.groups.push_back({source, events, make});
    }
    if (found.missing.empty()) {
        return;
    }
    const PerfAccess access = read_perf_access();
    for (const Uncountable& missing : found.missing) {
        const Explanation why = why_missing(access, source, missing);
        plan.missing.push_back({missing.event, {}, {}, source, why.reason, why.remedy});
    }
}

/// Counts these groups in one run.
std::vector<CounterValue> count_groups(const std::vector<CounterGroup>& groups, int threads,
                                       const CountedWork& run) {
    std::deque<ThreadCounters> counters;
    for (const CounterGroup& group : groups) {
        counters.emplace_back(group.events, group.make, threads);
    }
    run(Stopwatch([&counters] { std::ranges::for_each(counters, &ThreadCounters::start); },
                  [&counters] {
                      std::for_each(counters.rbegin(), counters.rend(), std::mem_fn(&ThreadCounters::stop));
                  }));
    std::vector<CounterValue> rows;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const auto counts = counters[g].counts();
        for (std::size_t k = 0; k < groups[g].events.size(); ++k) {
            for (std::size_t thread = 0; thread < counts.size(); ++thread) {
                rows.push_back(
                    {groups[g].events[k], static_cast<int>(thread), counts[thread][k], groups[g].source});
            }
        }
    }
    return rows;
}

} // namespace

CounterPlan plan_counters(const std::vector<std::string>& events) {
    std::vector<Alternatives> hardware;
    std::vector<Alternatives> software;
    for (const Alternatives& wanted : wanted_events(events)) {
        (is_software_event(wanted.front()) ? software : hardware).push_back(wanted);
    }
    CounterPlan plan;
    plan_source("papi-hardware", hardware, [] { return papi_event_set(CountedMode::user); }, plan);
    plan_source("papi-software", software, [] { return papi_event_set(CountedMode::user_and_kernel); }, plan);
    return plan;
}

std::vector<CounterValue> count(const std::vector<std::string>& events, int threads, const CountedWork& run) {
    const CounterPlan plan = plan_counters(events);
    const CounterGroup rusage{"rusage", rusage_events(), rusage_event_set};
    std::vector<CounterValue> rows;
    for (std::size_t g = 0; g < std::max<std::size_t>(plan.groups.size(), 1); ++g) {
        std::vector<CounterGroup> groups;
        if (g == 0) {
            groups.push_back(rusage);
        }
        if (g < plan.groups.size()) {
            groups.push_back(plan.groups[g]);
        }
        const auto counted = count_groups(groups, threads, run);
        rows.insert(rows.end(), counted.begin(), counted.end());
    }
    rows.push_back({"maximum_resident_bytes", {}, maximum_resident_bytes(), "rusage"});
    rows.insert(rows.end(), plan.missing.begin(), plan.missing.end());
    return rows;
}

} // namespace carom
