#include "harness/measure/stated_time.hpp"

#include <array>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/support/errors.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

using Json = nlohmann::json;

/// The library's matcher calls itself for each character: a longer line could take it off the stack.
constexpr std::size_t longest_line = 4096;

const std::set<std::string> fields_of_benchmark{"name",
                                                "family_index",
                                                "per_family_instance_index",
                                                "run_name",
                                                "run_type",
                                                "repetitions",
                                                "repetition_index",
                                                "threads",
                                                "iterations",
                                                "real_time",
                                                "cpu_time",
                                                "time_unit",
                                                "label",
                                                "error_occurred",
                                                "error_message",
                                                "aggregate_name",
                                                "aggregate_unit",
                                                "skipped",
                                                "skip_message"};

double seconds_of_unit(const std::string& unit) {
    constexpr std::array<std::pair<std::string_view, double>, 4> units{
        {{"ns", 1e-9}, {"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}}};
    for (const auto& [name, seconds] : units) {
        if (name == unit) {
            return seconds;
        }
    }
    throw InputError("time_unit: found '" + unit + "', expected ns, us, ms or s");
}

/// The runs that are no means or deviations of others, and are of the case: those of exactly that name if
/// there are any, or else those whose name goes on after it, as in BM_sort/8/real_time.
std::vector<Json> runs_of(const Json& benchmarks, const std::string& name) {
    std::vector<Json> exact;
    std::vector<Json> longer;
    for (const Json& run : benchmarks) {
        const std::string own = run.value("run_name", run.value("name", ""));
        if (run.value("run_type", "iteration") == "iteration") {
            if (own == name) {
                exact.push_back(run);
            } else if (own.starts_with(name + "/")) {
                longer.push_back(run);
            }
        }
    }
    return exact.empty() ? longer : exact;
}

std::regex regex_of(const std::string& pattern) {
    std::regex regex;
    try {
        regex.assign(pattern);
    } catch (const std::regex_error&) {
        throw InputError("time: found '" + pattern + "', expected a regular expression");
    }
    if (regex.mark_count() != 1) {
        throw InputError("time: found '" + pattern + "', expected a regular expression with one group");
    }
    return regex;
}

} // namespace

void require_pattern(const std::string& pattern) { regex_of(pattern); }

StatedTime time_in_output(const std::string& output, const std::string& pattern, double unit_seconds) {
    const std::regex regex = regex_of(pattern);
    std::vector<std::string> found;
    std::istringstream lines(output);
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (line.size() <= longest_line && std::regex_search(line, match, regex)) {
            found.push_back(match[1]);
        }
    }
    if (found.size() != 1) {
        throw InputError("time: '" + pattern + "' matches " + std::to_string(found.size()) +
                         " lines of standard output, expected one");
    }
    const auto number = parse_number<double>(found.front());
    if (!number || !(*number > 0)) {
        throw InputError("time: found '" + found.front() + "', expected a positive number");
    }
    return {.seconds = *number * unit_seconds, .cpu_seconds = 0, .counters = {}};
}

StatedTime time_of_benchmark(const std::string& json, const std::string& name) {
    const Json document = Json::parse(json, nullptr, false);
    if (!document.is_object() || !document.contains("benchmarks") || !document["benchmarks"].is_array()) {
        throw InputError("benchmark: found no JSON of Google Benchmark, expected what "
                         "--benchmark_out_format=json writes");
    }
    const std::vector<Json> runs = runs_of(document["benchmarks"], name);
    std::set<std::string> names;
    for (const Json& run : runs) {
        names.insert(run.value("run_name", run.value("name", "")));
    }
    if (names.size() != 1) {
        std::string found;
        for (const std::string& one : names) {
            found += (found.empty() ? ": " : ", ") + one;
        }
        throw InputError("benchmark: '" + name + "' is the name of " + std::to_string(names.size()) +
                         " cases" + found + "; expected one");
    }
    StatedTime time;
    const auto count = static_cast<double>(runs.size());
    for (const Json& run : runs) {
        if (run.value("error_occurred", false) || run.contains("skipped")) {
            throw InputError("benchmark: " + name + ": " +
                             run.value("error_message", run.value("skip_message", "it failed")));
        }
        const double unit = seconds_of_unit(run.value("time_unit", "ns"));
        time.seconds += run.value("real_time", 0.0) * unit / count;
        time.cpu_seconds += run.value("cpu_time", 0.0) * unit / count;
        for (const auto& [key, value] : run.items()) {
            if (value.is_number() && !fields_of_benchmark.contains(key)) {
                time.counters[key] += value.get<double>() / count;
            }
        }
    }
    if (!(time.seconds > 0)) {
        throw InputError("benchmark: " + name + ": found no time, expected a positive real_time");
    }
    return time;
}

} // namespace carom
