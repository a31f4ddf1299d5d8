#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "harness/counters/access.hpp"
#include "harness/counters/counters.hpp"
#include "kernels/policies.hpp"
#include "kernels/scene.hpp"

namespace carom {

/// What valgrind's cachegrind counts in the scene's first units of time, at most `units`, by one variant on
/// one thread: rows of the source "cachegrind" for instructions, data accesses, branches and their misses in
/// simulated caches and a simulated branch predictor, for the sizes of those caches in bytes, and for the
/// `steps` simulated.
///
/// Start-up and reading the scene do not count: the same scene is run without a step, too, and its counts are
/// subtracted. `program` is the carom that is run, this one if empty. What stands in the way becomes the
/// reason of rows without a value.
std::vector<CounterValue> simulate_counters(const Scene& scene, std::string_view variant,
                                            const Tuning& tuning, int units,
                                            const std::filesystem::path& program = {});

/// The names, in a record, of what it counts of what happened.
std::vector<std::string> simulated_counts();

/// What was counted over the whole program and the sizes of the caches, by their names in a record, from the
/// text of cachegrind's output file (valgrind's manual, "Cachegrind: output file format"). Throws
/// CounterError with what was found and what was expected.
std::map<std::string, double> parse_cachegrind(const std::string& text);

/// The version of the valgrind on PATH, as 3.19.0; empty if there is none.
std::string valgrind_version();

/// What to say then.
Explanation no_valgrind();

} // namespace carom
