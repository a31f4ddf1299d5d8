#pragma once

#include <map>
#include <string>

#include <gtest/gtest.h>

#include "harness/counters/cachegrind.hpp"
#include "harness/scenes/generate.hpp"

namespace carom::tests {

/// Why the built program cannot be run under valgrind here, or an empty text.
inline std::string no_simulation() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return "valgrind cannot run a program with sanitizers";
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    return "valgrind cannot run a program with sanitizers";
#endif
#endif
    return valgrind_version().empty() ? no_valgrind().reason : "";
}

inline Scene simulated_scene() {
    return generate(
        {.count = 1000, .side = 1000, .radius = 16, .steps = 10, .least_velocity = 2, .largest_velocity = 5});
}

/// What cachegrind counts in the scene's first units of time, by name; every row must have a value.
inline std::map<std::string, double> simulate(const char* variant, int units) {
    std::map<std::string, double> values;
    for (const CounterValue& row : simulate_counters(simulated_scene(), variant, {}, units, CAROM_PROGRAM)) {
        EXPECT_EQ(row.source, "cachegrind");
        EXPECT_FALSE(row.thread.has_value());
        EXPECT_TRUE(row.value.has_value()) << row.name << ": " << row.reason;
        values[row.name] = row.value.value_or(0);
    }
    return values;
}

} // namespace carom::tests
