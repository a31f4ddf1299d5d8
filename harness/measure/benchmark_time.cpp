// What Google Benchmark's report says of one case (stated_time.hpp).

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/measure/stated_time.hpp"
#include "harness/support/benchmark_json.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/json.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

using Json = nlohmann::json;

/// The numbers of a run that are no counters.
const std::set<std::string> numbers_of_benchmark{"family_index", "per_family_instance_index",
                                                 "repetitions",  "repetition_index",
                                                 "threads",      "iterations",
                                                 "real_time",    "cpu_time"};

std::string text_of(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

bool is_true(const Json& object, const char* key) { return object.value(key, Json()) == Json(true); }

/// A number as it is, which may be none; empty if there is no such field.
std::optional<double> number_of(const Json& object, const std::string& key) {
    const auto found = object.find(key);
    if (found == object.end() || !(found->is_number() || !not_finite(*found).empty())) {
        return std::nullopt;
    }
    return found->is_number() ? found->get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// What a field holds, to stand in a message.
std::string shown(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end()) {
        return std::string("no ") + key;
    }
    const std::string word = not_finite(*found);
    return std::string(key) + " " + (word.empty() ? in_quotes(json_text(*found, -1)) : word);
}

[[noreturn]] void refuse_case(const std::string& name, const std::string& found) {
    throw InputError("benchmark: " + on_one_line(name) + ": " + found);
}

double seconds_of_unit(const std::string& name, const std::string& unit) {
    constexpr std::array<std::pair<std::string_view, double>, 4> units{
        {{"ns", 1e-9}, {"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}}};
    for (const auto& [one, seconds] : units) {
        if (one == unit) {
            return seconds;
        }
    }
    refuse_case(name, "found time_unit " + in_quotes(unit) + ", expected ns, us, ms or s");
}

std::string name_of(const Json& run) {
    const std::string name = text_of(run, "run_name");
    return name.empty() ? text_of(run, "name") : name;
}

/// A row of the report: a run of a case, or an aggregate over all of its runs.
struct Row {
    std::string name;      ///< of the case
    std::string aggregate; ///< empty of a run
};

Row row_of(const Json& run) {
    return {name_of(run), text_of(run, "run_type") == "aggregate" ? text_of(run, "aggregate_name") : ""};
}

/// What of the report is about one case, or several of one name.
struct Case {
    std::vector<Json> runs;
    std::vector<std::pair<std::string, Json>> aggregates; ///< with their names
    bool is_several = false;
};

/// Those of exactly that name if there are any, or else those whose name goes on after it, as in
/// BM_sort/8/real_time; by their full names.
std::map<std::string, Case> cases_of(const Json& benchmarks, const std::string& name) {
    std::map<std::string, Case> cases;
    std::string last;
    for (const Json& run : benchmarks) {
        const Row row = row_of(run);
        // These two are over several cases.
        const bool is_of_family = row.aggregate == "BigO" || row.aggregate == "RMS";
        if (!is_of_family && (row.name == name || row.name.starts_with(name + "/"))) {
            Case& one = cases[row.name];
            if (row.aggregate.empty()) {
                // The library reports the repetitions of a case in one piece.
                one.is_several = one.is_several || (!one.runs.empty() && last != row.name);
                one.runs.push_back(run);
            } else {
                one.aggregates.emplace_back(row.aggregate, run);
            }
        }
        last = row.name;
    }
    if (cases.contains(name)) {
        std::erase_if(cases, [&name](const auto& one) { return one.first != name; });
    }
    return cases;
}

/// Whether several were registered with one name. Their families or instances differ (since version 1.5.5),
/// or else a number of a repetition, or an aggregate, comes twice.
bool is_several(const Case& one) {
    std::set<std::pair<double, double>> families;
    std::set<double> repetitions;
    std::set<std::string> aggregates;
    bool is_numbered = false;
    const auto note_family = [&](const Json& run) {
        const auto family = number_of(run, "family_index");
        is_numbered = is_numbered || family;
        families.emplace(family.value_or(0), number_of(run, "per_family_instance_index").value_or(0));
    };
    bool again = one.is_several;
    for (const Json& run : one.runs) {
        note_family(run);
        if (const auto repetition = number_of(run, "repetition_index")) {
            is_numbered = true;
            again = !repetitions.insert(*repetition).second || again;
        }
    }
    for (const auto& [name, aggregate] : one.aggregates) {
        note_family(aggregate);
        again = !aggregates.insert(name).second || again;
    }
    return families.size() > 1 || again || (!is_numbered && one.runs.size() > 1);
}

/// The runs that count: all repetitions, or the mean of them where the report has only aggregates.
std::vector<Json> counted_runs(const Case& one, const std::string& name) {
    if (!one.runs.empty()) {
        return one.runs;
    }
    std::string found;
    for (const auto& [which, aggregate] : one.aggregates) {
        if (which == "mean") {
            return {aggregate};
        }
        found += (found.empty() ? "" : ", ") + on_one_line(which);
    }
    refuse_case(name, "found only aggregates (" + found + "), expected runs or their mean");
}

/// Throws InputError unless it is a run with a time.
void require_time(const Json& run, const std::string& name) {
    if (is_true(run, "error_occurred") || is_true(run, "skipped")) {
        const std::string error = text_of(run, "error_message");
        const std::string said = error.empty() ? text_of(run, "skip_message") : error;
        const std::string how = is_true(run, "error_occurred") ? "failed" : "was skipped";
        refuse_case(name, how + (said.empty() ? " without a word" : ": " + on_one_line(said)));
    }
    if (number_of(run, "iterations").value_or(1) < 1) {
        refuse_case(name, "found iterations 0, expected one at least");
    }
    const double time = number_of(run, "real_time").value_or(0);
    if (!(time > 0) || !std::isfinite(time)) {
        refuse_case(name, "found " + shown(run, "real_time") + ", expected a positive number");
    }
}

/// The mean of a number over the runs; empty unless each has a finite one.
std::optional<double> mean_of(const std::vector<Json>& runs, const std::string& key) {
    double sum = 0;
    for (const Json& run : runs) {
        sum += number_of(run, key).value_or(std::numeric_limits<double>::quiet_NaN());
    }
    return std::isfinite(sum) ? std::optional(sum / static_cast<double>(runs.size())) : std::nullopt;
}

int threads_of(const Json& run) {
    const double threads = number_of(run, "threads").value_or(1);
    return threads > 1 && threads < 1e9 ? static_cast<int>(threads) : 1;
}

/// The one case of that name, with its full name. Throws InputError.
std::pair<std::string, Case> case_of(const Json& benchmarks, const std::string& name) {
    constexpr std::size_t most_told = 8;
    auto cases = cases_of(benchmarks, name);
    if (cases.size() != 1) {
        std::string found;
        std::size_t told = 0;
        for (const auto& [one, _] : cases) {
            found += told == 0 ? ": " : ", ";
            found += told < most_told ? on_one_line(one) : "...";
            if (++told > most_told) {
                break;
            }
        }
        throw InputError("benchmark: '" + on_one_line(name) + "' is the name of " +
                         number_text(cases.size()) + " cases" + found + "; expected one");
    }
    if (is_several(cases.begin()->second)) {
        throw InputError(
            "benchmark: '" + on_one_line(cases.begin()->first) +
            "' is the name of several cases; expected one, each registered by a name of its own");
    }
    return *cases.begin();
}

} // namespace

StatedTime time_of_benchmark(const std::string& json, const std::string& name) {
    const Json document = read_benchmark_json(json);
    const auto [full_name, found] = case_of(document["benchmarks"], name);
    std::vector<Json> runs = counted_runs(found, full_name);
    StatedTime time;
    for (Json& run : runs) {
        require_time(run, full_name);
        const std::string unit = text_of(run, "time_unit");
        const double seconds = seconds_of_unit(full_name, unit.empty() ? "ns" : unit);
        run["real_time"] = seconds * run["real_time"].get<double>();
        run["cpu_time"] = seconds * number_of(run, "cpu_time").value_or(0);
    }
    time.seconds = mean_of(runs, "real_time").value_or(0);
    time.cpu_seconds = mean_of(runs, "cpu_time").value_or(0);
    time.threads = threads_of(runs.front());
    for (const Json& run : runs) {
        for (const auto& [key, _] : run.items()) {
            if (number_of(run, key) && !numbers_of_benchmark.contains(key)) {
                time.counters[key] = mean_of(runs, key);
            }
        }
    }
    if (const Json context = document.value("context", Json()); context.contains("library_version")) {
        time.library_version = text_of(context, "library_version");
    }
    return time;
}

} // namespace carom
