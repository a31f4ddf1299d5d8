#include "harness/doctor/findings.hpp"

#include <algorithm>

#include "harness/counters/cachegrind.hpp"
#include "harness/counters/cachegrind_output.hpp"
#include "harness/counters/papi.hpp"
#include "harness/counters/rusage.hpp"
#include "harness/machine/threads.hpp"
#include "harness/processes/process.hpp"
#include "harness/support/free_memory.hpp"
#include "harness/support/silence.hpp"

namespace carom {
namespace {

std::optional<bool> read_turbo() {
    const auto off = first_line("/sys/devices/system/cpu/intel_pstate/no_turbo");
    const auto on = first_line("/sys/devices/system/cpu/cpufreq/boost");
    return off ? std::optional(*off == "0") : on ? std::optional(*on == "1") : std::nullopt;
}

std::vector<CounterSource> counter_sources() {
    std::vector<CounterSource> sources{{.name = "papi-hardware"},
                                       {.name = "papi-software"},
                                       {.name = "rusage", .events = rusage_events(), .runs = 1},
                                       {.name = "cachegrind"}};
    const auto named = [&sources](const std::string& name) -> CounterSource& {
        return *std::ranges::find(sources, name, &CounterSource::name);
    };
    const CounterPlan plan = plan_counters({});
    for (const CounterGroup& group : plan.groups) {
        CounterSource& source = named(group.source);
        ++source.runs;
        source.events.insert(source.events.end(), group.events.begin(), group.events.end());
    }
    for (const CounterValue& value : plan.missing) {
        named(value.source).missing.push_back(value);
    }
    CounterSource& simulated = named("cachegrind");
    simulated.runs = valgrind_version().empty() ? 0 : 1;
    const auto [reason, remedy] = no_valgrind();
    for (const SimulatedName& name : simulated_counts()) {
        const std::string event(name.counter);
        if (simulated.runs > 0) {
            simulated.events.push_back(event);
        } else {
            simulated.missing.push_back({event, {}, {}, simulated.name, reason, remedy});
        }
    }
    return sources;
}

} // namespace

Findings examine_machine(double noise_seconds) {
    const Silence silence;
    // Noise comes first: what follows starts programs, which may still be at work.
    const Noise noise = measure_noise(noise_seconds);
    return {.machine = read_machine(),
            .memory_available_bytes = available_memory(),
            .topology = read_topology(),
            .turbo = read_turbo(),
            .usable_processors = usable_processors(),
            .threads_by_default = default_threads(),
            .openmp = read_openmp(),
            .papi = papi_version(),
            .perf = read_perf_access(),
            .counters = counter_sources(),
            .tools = {{"g++", "g++", version_line("g++")},
                      {"clang++", "clang", version_line("clang++")},
                      {"valgrind", "valgrind", version_line("valgrind")},
                      {"perf", "linux-perf", version_line("perf")}},
            .slurm_version = version_line("srun"),
            .slurm_job = slurm_variables(),
            .noise = noise};
}

} // namespace carom
