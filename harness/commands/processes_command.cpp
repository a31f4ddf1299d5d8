#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/measurement_options.hpp"
#include "harness/measure/stated_time.hpp"
#include "harness/records/process_json.hpp"
#include "harness/records/record.hpp"
#include "harness/side_by_side/contender_run.hpp"
#include "harness/side_by_side/together.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/json.hpp"
#include "harness/support/note.hpp"
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

/// Those that the file of `carom processes` describes. Throws InputError, which names the process and the
/// key, before anything runs.
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

struct ProcessesOptions {
    std::string file;
    Together how;
};

std::optional<StatedTime> stated_time(const DescribedProcess& one, const ProcessEnd& end) {
    if (!one.benchmark.empty()) {
        const std::string json = read_file(one.output);
        std::filesystem::remove(one.output); // so that nothing is taken for what the next run wrote
        return time_of_benchmark(json, one.benchmark);
    }
    const std::string& pattern = one.contender.command.pattern;
    if (pattern.empty()) {
        return std::nullopt;
    }
    std::string lines;
    for (const std::string& line : end.output.matched) {
        lines += line + '\n';
    }
    return time_in_output(lines, pattern, one.unit_seconds);
}

/// Takes the time that a run says, if it says one.
std::string take(ProcessMeasurement& one, const ProcessEnd& end) {
    try {
        if (auto stated = stated_time(one.its, end)) {
            one.stated.push_back(*std::move(stated));
        }
    } catch (const InputError& error) {
        one.exit_code = 1;
        return error.what();
    }
    return "";
}

ProgramContender contender_of(ProcessMeasurement& one) {
    ProgramContender contender = one.its.contender;
    contender.failure = [&one](const ProcessEnd& end) {
        one.exit_code = exit_code_of_failure(end);
        return why_failed(one.its.contender.command, end, one.its.exit_codes);
    };
    contender.take = [&one](const ProcessEnd& end) { return take(one, end); };
    return contender;
}

/// Times of unlike versions of a library are none of one kind: none of them counts.
void refuse_unlike_times(std::deque<ProcessMeasurement>& all) {
    for (auto one = all.begin(); one != all.end(); ++one) {
        for (auto other = one + 1; other != all.end(); ++other) {
            if (one->stated.empty() || other->stated.empty()) {
                continue;
            }
            if (const auto why = unlike_times(one->stated.back(), other->stated.back())) {
                one->measured.failure = other->measured.failure = *why;
            }
        }
    }
}

std::deque<ProcessMeasurement> measure(const ProcessesOptions& options) {
    std::deque<ProcessMeasurement> all;
    for (DescribedProcess& one : read_processes(options.file)) {
        all.emplace_back(std::move(one));
    }
    std::vector<ProgramContender> contenders;
    std::ranges::transform(all, std::back_inserter(contenders), contender_of);
    std::vector<Measured> measured = measure_together(contenders, options.how);
    for (std::size_t k = 0; k < all.size(); ++k) {
        all[k].measured = std::move(measured[k]);
    }
    refuse_unlike_times(all);
    return all;
}

/// Says what was not as one may think, of a program that was measured.
void tell(const std::string& name, const Measured& measured) {
    constexpr double worth_telling = 0.1;
    if (!measured.undisturbed.empty()) {
        note(name + ": measured without a pause, in a stretch of its own: " + measured.undisturbed);
    }
    const ProcessEnd& end = measured.runs.back();
    if (measured.seconds_alone > worth_telling * end.wall_seconds()) {
        note(format(
            "%s: ran %.3g of its %.3g s after all others had ended, since their lengths were not those "
            "expected",
            name.c_str(), measured.seconds_alone, end.wall_seconds()));
    }
    if (end.ran_on > 0) {
        note(format("%s: did not stand still %d times, and ran on beside the others", name.c_str(),
                    end.ran_on));
    }
}

Json scene_of(const std::string& path) {
    if (path.empty()) {
        return nullptr;
    }
    const LoadedScene loaded = load_scene(path);
    return scene_json(loaded.scene, loaded.name, loaded.sha256);
}

/// Leaves the record of a process that ended, or of its failure; returns why it failed, or nothing.
std::string keep(const ProcessMeasurement& one, int contenders, std::uint64_t seed) {
    std::string reason = one.measured.failure;
    if (reason.empty()) {
        try {
            write_record(one.its.record, process_json(one, scene_of(one.its.scene), contenders, seed));
            tell(one.its.contender.command.words.front(), one.measured);
        } catch (const InputError& error) {
            reason = error.what();
        }
    }
    if (!reason.empty()) {
        write_record(one.its.record, failure_json(one, reason));
    }
    return reason;
}

void processes(const ProcessesOptions& options) {
    const std::deque<ProcessMeasurement> all = measure(options);
    std::string first_reason;
    for (const ProcessMeasurement& one : all) {
        const std::string reason = keep(one, static_cast<int>(all.size()), options.how.seed);
        if (first_reason.empty() && !reason.empty()) {
            first_reason = one.its.contender.command.words.front() + ": " + reason;
        }
    }
    if (!first_reason.empty()) {
        throw InputError(first_reason);
    }
}

} // namespace

void add_processes_command(CLI::App& program) {
    auto options = std::make_shared<ProcessesOptions>();
    CLI::App* command = program.add_subcommand(
        "processes", "Time whole processes of any programs from outside, side by side in slices of time");
    command
        ->add_option("PROCESSES", options->file,
                     "JSON file: a list with, for each process, an object with its command (a list of words) "
                     "and the file for its record")
        ->required();
    add_number(
        *command, "--slice", options->how.slice_seconds, 1e-3, 1e6,
        "Seconds that the shortest runs before the next does, the others in proportion; longer where it "
        "takes more than a tenth of that until a program stands still");
    add_number(*command, "--seed", options->how.seed, 0, std::numeric_limits<std::uint64_t>::max(),
               "Of the order of the slices");
    command->callback([options] { processes(*options); });
}

} // namespace carom
