#include "harness/measure/bench_case.hpp"

#include <utility>

#include "harness/measure/energy_drift.hpp"
#include "harness/measure/warm_up.hpp"

namespace carom {

std::string BenchCase::name() const {
    return std::string(measurement_.variant.name) + "/" + measurement_.scene_name +
           "/threads:" + std::to_string(measurement_.tuning.threads);
}

void BenchCase::run(benchmark::State& state) {
    if (!simulation_) {
        simulation_ = measurement_.variant.simulate(measurement_.scene, measurement_.tuning);
        warm_up(measurement_, *simulation_);
    }
    double seconds = 0;
    suspensions_.start();
    for (auto iteration : state) {
        static_cast<void>(iteration);
        if (measurement_.violation) {
            break;
        }
        state.PauseTiming();
        simulation_->restart(measurement_.scene);
        Stopwatch stopwatch([&state] { state.ResumeTiming(); }, [&state] { state.PauseTiming(); });
        measurement_.add(run_scene(measurement_.scene, *simulation_, measurement_.tuning,
                                   Check(CheckScope::last_step, measurement_.variant), nullptr,
                                   std::move(stopwatch)));
        state.ResumeTiming();
        state.SetIterationTime(measurement_.repetitions.back().steps_seconds);
        seconds += measurement_.repetitions.back().steps_seconds;
    }
    if (!suspended_) {
        suspended_ = suspensions_.reason();
    }
    if (measurement_.violation) {
        state.SkipWithError(measurement_.violation->c_str());
    } else if (suspended_) {
        state.SkipWithError(suspended_->c_str());
    } else {
        set_counters(state, seconds / static_cast<double>(state.iterations()));
    }
}

void BenchCase::set_counters(benchmark::State& state, double mean_seconds) const {
    const Scene& scene = measurement_.scene;
    const Run& run = measurement_.repetitions.back();
    const double steps = static_cast<double>(scene.steps) * measurement_.tuning.substeps;
    state.counters["steps"] = steps;
    state.counters["disc_steps_per_second"] = static_cast<double>(scene.discs.size()) * steps / mean_seconds;
    state.counters["overlaps"] = static_cast<double>(run.work.overlaps);
    state.counters["pair_resolves"] = static_cast<double>(run.work.pair_resolves);
    state.counters["wall_resolves"] = static_cast<double>(run.work.wall_resolves);
    state.counters["sweeps"] = static_cast<double>(run.work.sweeps);
    state.counters["energy_drift"] = energy_drift(scene, run.discs).value_or(0);
    state.counters["discs_outside"] = discs_outside(scene, run.discs);
}

} // namespace carom
