// A Google Benchmark with a case for each amount of work, in hundredths of the first.

#include <cstdint>

#include <benchmark/benchmark.h>

#include "harness/tests/calibration/loop.hpp"

namespace {

/// Some 5 ms of work for the case of 100.
constexpr std::uint64_t loops_of_a_hundredth = 30'000;

void loop(benchmark::State& state) {
    const std::uint64_t loops = loops_of_a_hundredth * static_cast<std::uint64_t>(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(carom::loop(loops));
    }
}

// A single iteration: the same work in every process, whatever the clock says.
BENCHMARK(loop)->Arg(100)->Arg(101)->Arg(102)->Arg(103)->Arg(105)->Arg(110)->Iterations(1);

} // namespace

BENCHMARK_MAIN();
