#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace carom {

/// A figure of cachegrind and the name that it has in a record.
struct SimulatedName {
    std::string_view cachegrind;
    std::string_view counter;
};

/// Of what happened: instructions, data accesses, branches, and misses.
std::span<const SimulatedName> simulated_counts();

/// Of the simulated caches, in bytes.
std::span<const SimulatedName> simulated_sizes();

/// All of them, over the whole program, from the text of cachegrind's output file (valgrind's manual,
/// "Cachegrind: output file format"). Throws CounterError with what was found and what was expected.
std::map<std::string_view, double> parse_cachegrind(std::string_view text);

} // namespace carom
