#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/machine/topology.hpp"

namespace carom {

/// What repetitions of the same work reached, per second. Whatever disturbs them makes them slower, so the
/// best is the machine's limit; the median tells how often it is reached.
struct Rate {
    double best = 0;
    double median = 0;
    int repetitions = 0;
};

/// How much memory a copy works in, both arrays together over all threads, and the level that can hold it.
struct WorkingSet {
    std::string level; ///< L1d, L2, ... or memory
    std::int64_t bytes = 0;
};

/// From 32 KiB by factors of four up to arrays in memory: each four times all caches of the last level, as
/// McCalpin's STREAM demands, but both no more than `most_bytes`. A level holds what fits the
/// caches of it that `threads` threads have.
std::vector<WorkingSet> working_sets(const Topology& topology, std::int64_t most_bytes, int threads);

/// Bytes read and written per second while each thread copies its part of one array into another: the copy of
/// STREAM (J. D. McCalpin, "Memory bandwidth and machine balance in current high performance computers", IEEE
/// TCCA Newsletter, December 1995), where the first repetition does not count either. Each thread touches its
/// part first. Repeats for about so many seconds, five times at least. Throws InputError
/// like `require_threads`, CheckError if the copy is no copy.
Rate measure_copy(const WorkingSet& set, int threads, double seconds);

/// How the doubles of the probe are held: one a register, or as many as the compiler was told a register has.
enum class Arithmetic { scalar, vector };

/// The doubles in a register that the program was compiled for: 2 with SSE2 and NEON, 4 with AVX, 8 with
/// AVX-512.
int lanes(Arithmetic arithmetic);

/// Multiplications and additions per second, a fused one never: every thread runs chains of x * a + b that do
/// not wait for each other. Repeats and throws like `measure_copy`.
Rate measure_arithmetic(Arithmetic arithmetic, int threads, double seconds);

/// What this machine can do at most, for 1 ... `threads` threads, as the record's `limits`; each rate takes
/// about so many seconds, and no copy more than `most_bytes`. Throws like `measure_copy`.
nlohmann::ordered_json measure_limits(int threads, double seconds, std::int64_t most_bytes);

/// As lines for the reader.
std::string limits_text(const nlohmann::ordered_json& limits);

} // namespace carom
