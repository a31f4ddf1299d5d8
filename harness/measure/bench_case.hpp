#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>

#include "harness/machine/suspensions.hpp"
#include "harness/measure/energy_drift.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/measure/warm_up.hpp"

namespace carom {

/// One variant on one scene with one tuning, as a case of Google Benchmark: an iteration is a whole run of S
/// steps from the scene's initial state, its manual time the wall time of the steps alone. All runs, those
/// that warm up among them, are of one simulation: no memory is touched first while it is timed. Each run is
/// checked (its last step, or before the first of them every step) and must end in the same state, to the
/// last bit; a case that fails, or stood still while it was timed, is skipped with its error and has no time.
class BenchCase {
  public:
    explicit BenchCase(Measurement measurement) : measurement_(std::move(measurement)) {}

    /// Variant, scene and threads, as in published/scene.in/threads:2.
    std::string name() const {
        return std::string(measurement_.variant.name) + "/" + measurement_.scene_name +
               "/threads:" + std::to_string(measurement_.tuning.threads);
    }

    void run(benchmark::State& state) {
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

    /// Notes a violation found after the runs.
    void fail(const std::string& violation) { measurement_.violation = violation; }

    /// Why its times do not count, if it stood still while it was timed.
    const std::optional<std::string>& suspended() const { return suspended_; }

    const Measurement& measurement() const { return measurement_; }

  private:
    /// Of the runs of one measurement, which took so long on average; they all did the same work.
    void set_counters(benchmark::State& state, double mean_seconds) const {
        const Scene& scene = measurement_.scene;
        const Run& run = measurement_.repetitions.back();
        const double steps = static_cast<double>(scene.steps) * measurement_.tuning.substeps;
        state.counters["steps"] = steps;
        state.counters["disc_steps_per_second"] =
            static_cast<double>(scene.discs.size()) * steps / mean_seconds;
        state.counters["overlaps"] = static_cast<double>(run.work.overlaps);
        state.counters["pair_resolves"] = static_cast<double>(run.work.pair_resolves);
        state.counters["wall_resolves"] = static_cast<double>(run.work.wall_resolves);
        state.counters["sweeps"] = static_cast<double>(run.work.sweeps);
        state.counters["energy_drift"] = energy_drift(scene, run.discs).value_or(0);
        state.counters["discs_outside"] = discs_outside(scene, run.discs);
    }

    Measurement measurement_;
    Suspensions suspensions_;
    std::optional<std::string> suspended_;
    std::unique_ptr<Simulation> simulation_; ///< of all runs; none before the first
};

} // namespace carom
