#pragma once

#include <memory>
#include <optional>
#include <string>

#include <benchmark/benchmark.h>

#include "harness/machine/suspensions.hpp"
#include "harness/measure/measurement.hpp"

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
    std::string name() const;

    void run(benchmark::State& state);

    /// Notes a violation found after the runs.
    void fail(const std::string& violation) { measurement_.violation = violation; }

    /// Why its times do not count, if it stood still while it was timed.
    const std::optional<std::string>& suspended() const { return suspended_; }

    const Measurement& measurement() const { return measurement_; }

  private:
    /// Of the runs of one measurement, which took so long on average; they all did the same work.
    void set_counters(benchmark::State& state, double mean_seconds) const;

    Measurement measurement_;
    Suspensions suspensions_;
    std::optional<std::string> suspended_;
    std::unique_ptr<Simulation> simulation_; ///< of all runs; none before the first
};

} // namespace carom
