#include "harness/command_line/described_process.hpp"

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include <unistd.h>

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
    std::vector<std::string> variables;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string text = *variable;
        if (!more.contains(text.substr(0, text.find('=')))) {
            variables.push_back(text);
        }
    }
    for (const auto& [name, value] : more) {
        variables.push_back(name);
        variables.back() += '=' + value;
    }
    return variables;
}

template <class Value> constexpr const char* kind() {
    if constexpr (std::is_same_v<Value, std::string>) {
        return "a text";
    } else if constexpr (std::is_same_v<Value, bool>) {
        return "true or false";
    } else if constexpr (std::is_integral_v<Value>) {
        return "a whole number";
    } else if constexpr (std::is_floating_point_v<Value>) {
        return "a number";
    } else if constexpr (std::is_same_v<Value, std::vector<int>>) {
        return "a list of whole numbers";
    } else if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
        return "a list of texts";
    } else {
        return "an object of texts";
    }
}

/// The value of a key, or `otherwise` where the key is not there. Throws InputError.
template <class Value>
Value value_of(const Json& process, const char* key, const std::optional<Value>& otherwise = std::nullopt) {
    const auto found = process.find(key);
    if (found == process.end()) {
        if (otherwise) {
            return *otherwise;
        }
        throw InputError(std::string(key) + ": found none, expected " + kind<Value>());
    }
    try {
        return found->template get<Value>();
    } catch (const Json::exception&) {
        throw InputError(std::string(key) + ": found " + in_quotes(json_text(*found, -1)) + ", expected " +
                         kind<Value>());
    }
}

std::string text_of(const Json& process, const char* key) { return value_of<std::string>(process, key, ""); }

/// Of one that times itself in short processes: so often at most in one measurement.
constexpr int most_rounds_of_a_benchmark = 20;

using ListOfWords = std::vector<std::string>;
using Texts = std::map<std::string, std::string>;

KeptBy kept_by(const std::string& word) {
    if (word.empty()) {
        return KeptBy::whatever_works;
    }
    if (word != "cgroup" && word != "subreaper") {
        throw InputError("kept_by: found " + in_quotes(word) + ", expected cgroup or subreaper");
    }
    return word == "cgroup" ? KeptBy::cgroup : KeptBy::subreaper;
}

ProgramContender contender(const Json& json) {
    ProgramContender one;
    one.command = {.words = value_of<ListOfWords>(json, "command"),
                   .folder = text_of(json, "folder"),
                   .environment = environment_with(value_of(json, "environment", std::optional(Texts()))),
                   .most_seconds = value_of<double>(json, "most_seconds", 600.0),
                   .pattern = text_of(json, "pattern")};
    one.prepare = value_of<ListOfWords>(json, "prepare", ListOfWords());
    one.conclude = value_of<ListOfWords>(json, "conclude", ListOfWords());
    one.fresh_folder = value_of<bool>(json, "fresh_folder", false);
    one.warm_ups = value_of<int>(json, "warm_ups", 0);
    one.expected_seconds = value_of<double>(json, "expected_seconds", 0.0);
    if (json.contains("turns")) {
        one.turns = value_of<bool>(json, "turns");
    }
    one.kept_by = kept_by(text_of(json, "kept_by"));
    const bool is_benchmark = !text_of(json, "benchmark").empty();
    one.times_itself = is_benchmark || !one.command.pattern.empty();
    one.most_rounds = is_benchmark ? most_rounds_of_a_benchmark : 1;
    return one;
}

/// The system takes a word to end at a zero byte.
void require_words(const char* key, const ListOfWords& words) {
    if (!words.empty() && words.front().empty()) {
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
    if (contender.command.words.empty()) {
        throw InputError("command: found no word, expected a program and its arguments");
    }
    require_words("command", contender.command.words);
    require_words("prepare", contender.prepare);
    require_words("conclude", contender.conclude);
    if (!(contender.command.most_seconds > 0)) {
        throw InputError("most_seconds: found " + number_text(contender.command.most_seconds) +
                         ", expected a number above 0");
    }
    require_at_least("expected_seconds", contender.expected_seconds, 0);
    require_at_least("warm_ups", contender.warm_ups, 0);
    require_at_least("threads", one.threads, 1);
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
    DescribedProcess one{.contender = contender(json),
                         .record = value_of<std::string>(json, "record"),
                         .tags = value_of<ListOfWords>(json, "tags", ListOfWords()),
                         .sources = value_of<ListOfWords>(json, "sources", ListOfWords()),
                         .written = value_of(json, "written", std::optional(Texts())),
                         .exit_codes = value_of(json, "exit_codes", std::optional(std::vector<int>{0})),
                         .scene = text_of(json, "scene"),
                         .checked = text_of(json, "checked"),
                         .threads = value_of<int>(json, "threads", 1),
                         .axes = json.value("axes", Json::object()),
                         .build = json.value("build", Json::object()),
                         .unit_seconds = value_of<double>(json, "unit_seconds", 1.0),
                         .benchmark = text_of(json, "benchmark"),
                         .output = text_of(json, "output")};
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
