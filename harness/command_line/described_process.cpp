#include "harness/command_line/described_process.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "harness/measure/stated_time.hpp"
#include "harness/records/record.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/json.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> environment_with(const std::map<std::string, std::string>& more) {
    std::vector<std::string> variables = own_environment();
    std::erase_if(variables, [&more](const std::string& variable) {
        return more.contains(variable.substr(0, variable.find('=')));
    });
    for (const auto& [name, value] : more) {
        variables.push_back(name);
        variables.back() += '=' + value;
    }
    return variables;
}

/// Takes the value of a key. Throws InputError.
template <class Value> void require(const Json& process, const char* key, Value& value) {
    const auto found = process.find(key);
    if (found == process.end()) {
        throw InputError(std::string(key) + ": found none, expected one");
    }
    try {
        found->get_to(value);
    } catch (const Json::exception&) {
        throw InputError(std::string(key) + ": found " + in_quotes(json_text(*found, -1)) +
                         ", expected another kind of value");
    }
}

/// The same where the key is there; else `value` stays.
template <class Value> void take(const Json& process, const char* key, Value& value) {
    if (process.contains(key)) {
        require(process, key, value);
    }
}

template <class Value> void take(const Json& process, const char* key, std::optional<Value>& value) {
    if (process.contains(key)) {
        require(process, key, value.emplace());
    }
}

/// Of one that times itself in short processes: so often at most in one measurement.
constexpr int most_rounds_of_a_benchmark = 20;

ProgramContender contender(const Json& json, bool is_benchmark) {
    ProgramContender one;
    std::map<std::string, std::string> environment;
    require(json, "command", one.command.words);
    take(json, "folder", one.command.folder);
    take(json, "environment", environment);
    take(json, "most_seconds", one.command.most_seconds);
    take(json, "pattern", one.command.pattern);
    take(json, "prepare", one.prepare);
    take(json, "conclude", one.conclude);
    take(json, "fresh_folder", one.fresh_folder);
    take(json, "warm_ups", one.warm_ups);
    take(json, "expected_seconds", one.expected_seconds);
    take(json, "turns", one.turns);
    one.command.environment = environment_with(environment);
    one.times_itself = is_benchmark || !one.command.pattern.empty();
    take(json, "rounds", one.rounds);
    one.most_rounds = is_benchmark && !one.rounds ? most_rounds_of_a_benchmark : 1;
    return one;
}

/// The system takes a word to end at a zero byte.
void require_words(const char* key, const std::vector<std::string>& words, bool may_be_none = true) {
    if (words.empty() ? !may_be_none : words.front().empty()) {
        throw InputError(std::string(key) + ": found no word, expected a program and its arguments");
    }
    for (const std::string& word : words) {
        if (word.find('\0') != std::string::npos) {
            throw InputError(std::string(key) + ": found " + in_quotes(word) +
                             " with a zero byte, expected words without");
        }
    }
}

void require_at_least(const char* key, double found, double least) {
    if (!(found >= least)) {
        throw InputError(std::string(key) + ": found " + number_text(found) +
                         ", expected a number of at least " + number_text(least));
    }
}

void require_usable(const DescribedProcess& one) {
    const ProgramContender& contender = one.contender;
    require_words("command", contender.command.words, false);
    require_words("prepare", contender.prepare);
    require_words("conclude", contender.conclude);
    if (!(contender.command.most_seconds > 0)) {
        throw InputError("most_seconds: found " + number_text(contender.command.most_seconds) +
                         ", expected a number above 0");
    }
    require_at_least("expected_seconds", contender.expected_seconds, 0);
    require_at_least("warm_ups", contender.warm_ups, 0);
    require_at_least("threads", one.threads, 1);
    require_at_least("rounds", contender.rounds.value_or(1), 1);
    if (one.exit_codes.empty()) {
        throw InputError("exit_codes: found none, expected those that are fine");
    }
    if (!contender.command.pattern.empty()) {
        require_pattern(contender.command.pattern);
    }
    tags_json(one.tags);
    require_writable(one.record);
}

DescribedProcess described(const Json& json) {
    DescribedProcess one;
    take(json, "benchmark", one.benchmark);
    one.contender = contender(json, !one.benchmark.empty());
    require(json, "record", one.record);
    take(json, "tags", one.tags);
    take(json, "sources", one.sources);
    take(json, "written", one.written);
    take(json, "exit_codes", one.exit_codes);
    take(json, "scene", one.scene);
    take(json, "checked", one.checked);
    take(json, "threads", one.threads);
    one.axes = json.value("axes", one.axes);
    one.build = json.value("build", one.build);
    take(json, "unit_seconds", one.unit_seconds);
    take(json, "output", one.output);
    require_usable(one);
    return one;
}

} // namespace

std::vector<DescribedProcess> read_processes(const std::string& path) {
    const Json json = Json::parse(read_file(path), nullptr, false);
    if (!json.is_array() || json.empty() ||
        !std::ranges::all_of(json, [](const Json& one) { return one.is_object(); })) {
        throw InputError(path +
                         ": found something else, expected a JSON list with an object for each process");
    }
    std::vector<DescribedProcess> processes;
    for (const Json& one : json) {
        try {
            DescribedProcess next = described(one);
            if (std::ranges::find(processes, next.record, &DescribedProcess::record) != processes.end()) {
                throw InputError("record: found " + in_quotes(next.record) +
                                 " for two processes, expected a file for each");
            }
            processes.push_back(std::move(next));
        } catch (const InputError& error) {
            throw InputError(path + ", process " + std::to_string(processes.size() + 1) + ": " +
                             error.what());
        }
    }
    return processes;
}

} // namespace carom
