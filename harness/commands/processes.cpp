#include <algorithm>
#include <cstdint>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/measurement_options.hpp"
#include "harness/measure/process.hpp"
#include "harness/measure/stated_time.hpp"
#include "harness/records/process_json.hpp"
#include "harness/records/record.hpp"
#include "harness/support/child_process.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/json.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

struct ProcessesOptions {
    std::string file;
    double slice_seconds = 0.05;
    std::uint64_t seed = 1;
};

/// One program as the file describes it.
struct Described {
    ProcessCommand command;
    std::string record;
    std::vector<std::string> tags;
    std::vector<std::string> sources;
    std::string scene;
    std::string checked;
    int threads = 1;
    int warm_ups = 0;
    Json axes = Json::object();
    Json build = Json::object(); ///< of its record's provenance, what is not as this program's
    std::string pattern;         ///< of the time that it prints; empty if it is timed from outside
    double unit_seconds = 1;
    std::string benchmark; ///< the case of a Google Benchmark; empty if it is none
    std::string output;    ///< the file that the benchmark writes
};

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
    } else if constexpr (std::is_integral_v<Value>) {
        return "a whole number";
    } else if constexpr (std::is_floating_point_v<Value>) {
        return "a number";
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

Described described(const Json& json) {
    using Words = std::vector<std::string>;
    Described one{.command = {.words = value_of<Words>(json, "command"),
                              .folder = text_of(json, "folder"),
                              .environment = environment_with(value_of(
                                  json, "environment", std::optional(std::map<std::string, std::string>()))),
                              .most_seconds = value_of<double>(json, "most_seconds", 600.0)},
                  .record = value_of<std::string>(json, "record"),
                  .tags = value_of<Words>(json, "tags", Words()),
                  .sources = value_of<Words>(json, "sources", Words()),
                  .scene = text_of(json, "scene"),
                  .checked = text_of(json, "checked"),
                  .threads = value_of<int>(json, "threads", 1),
                  .warm_ups = value_of<int>(json, "warm_ups", 0),
                  .axes = json.value("axes", Json::object()),
                  .build = json.value("build", Json::object()),
                  .pattern = text_of(json, "pattern"),
                  .unit_seconds = value_of<double>(json, "unit_seconds", 1.0),
                  .benchmark = text_of(json, "benchmark"),
                  .output = text_of(json, "output")};
    if (one.command.words.empty() || one.command.words.front().empty()) {
        throw InputError("command: found no word, expected a program and its arguments");
    }
    if (one.command.most_seconds <= 0) {
        throw InputError("most_seconds: found " + number_text(one.command.most_seconds) +
                         ", expected a number above 0");
    }
    tags_json(one.tags);
    require_writable(one.record);
    return one;
}

/// Throws InputError.
std::vector<Described> read_processes(const std::string& path) {
    const Json json = Json::parse(read_file(path), nullptr, false);
    if (!json.is_array() || json.empty() ||
        !std::ranges::all_of(json, [](const Json& one) { return one.is_object(); })) {
        throw InputError(path +
                         ": found something else, expected a JSON list with an object for each process");
    }
    std::vector<Described> processes;
    for (const Json& one : json) {
        try {
            processes.push_back(described(one));
        } catch (const InputError& error) {
            throw InputError(path + ", process " + std::to_string(processes.size() + 1) + ": " +
                             error.what());
        }
    }
    return processes;
}

/// Why a process that ended does not count; empty if it does.
std::string failure_of(const Described& one, const ProcessEnd& end) {
    const std::string said = last_line(end.error);
    const std::string after = said.empty() ? "" : ": " + said;
    if (!end.not_started.empty()) {
        const std::string& folder = one.command.folder;
        return "cannot be run" + (folder.empty() ? "" : " in " + folder) + ": " + end.not_started;
    }
    if (end.out_of_time) {
        return format("took longer than %g s and was stopped", one.command.most_seconds);
    }
    if (end.signal != 0) {
        return std::string("killed by SIG") + sigabbrev_np(end.signal) + after;
    }
    if (end.exit_code != 0) {
        return format("exit code %d", end.exit_code) + (said.empty() ? " without a word" : after);
    }
    return "";
}

std::optional<StatedTime> stated_time(const Described& one, const ProcessEnd& end) {
    if (!one.benchmark.empty()) {
        return time_of_benchmark(read_file(one.output), one.benchmark);
    }
    if (!one.pattern.empty()) {
        return time_in_output(end.output, one.pattern, one.unit_seconds);
    }
    return std::nullopt;
}

void write_record_of(const Described& one, const ProcessEnd& end, const std::optional<Turns>& turns) {
    Json scene = nullptr;
    if (!one.scene.empty()) {
        const LoadedScene loaded = load_scene(one.scene);
        scene = scene_json(loaded.scene, loaded.name, loaded.sha256);
    }
    write_record(one.record, process_json({.command = one.command,
                                           .end = end,
                                           .stated = stated_time(one, end),
                                           .turns = turns,
                                           .axes = one.axes,
                                           .scene = scene,
                                           .sources = sources_json(one.sources),
                                           .build = one.build,
                                           .checked = one.checked,
                                           .tags = one.tags,
                                           .threads = one.threads,
                                           .warm_ups = one.warm_ups}));
}

int exit_code_of(const ProcessEnd& end) {
    constexpr int out_of_time = 124;
    constexpr int cannot_be_run = 127;
    if (end.out_of_time) {
        return out_of_time;
    }
    if (end.signal != 0) {
        return -end.signal;
    }
    return end.not_started.empty() ? std::max(end.exit_code, 1) : cannot_be_run;
}

/// In the place of the record of a process that failed.
void write_failure(const Described& one, const ProcessEnd& end, const std::string& reason) {
    write_record(one.record, {{"schema_version", 1},
                              {"kind", "failure"},
                              {"tags", tags_json(one.tags)},
                              {"axes", one.axes},
                              {"command", one.command.words},
                              {"exit_code", exit_code_of(end)},
                              {"reason", reason},
                              {"recorded_at", utc_now()}});
}

/// Leaves the record of a process that ended, or of its failure; returns why it failed, or nothing.
std::string keep(const Described& one, const ProcessEnd& end, const std::optional<Turns>& turns) {
    std::string reason = failure_of(one, end);
    if (reason.empty()) {
        try {
            write_record_of(one, end, turns);
        } catch (const InputError& error) {
            reason = error.what();
        }
    }
    if (!reason.empty()) {
        write_failure(one, end, reason);
    }
    return reason;
}

void processes(const ProcessesOptions& options) {
    const std::vector<Described> all = read_processes(options.file);
    for (const Described& one : all) {
        for (int run = 0; run < one.warm_ups; ++run) {
            Process(one.command).advance(one.command.most_seconds);
        }
    }
    std::deque<Process> running;
    std::vector<Process*> everyone;
    everyone.reserve(all.size());
    for (const Described& one : all) {
        everyone.push_back(&running.emplace_back(one.command));
    }
    take_slices(everyone, options.slice_seconds, options.seed);
    std::string first_reason;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const ProcessEnd end = running[k].end();
        std::optional<Turns> turns;
        if (all.size() > 1) {
            turns = {
                .contenders = static_cast<int>(all.size()), .seed = options.seed, .seconds = end.seconds};
        }
        const std::string reason = keep(all[k], end, turns);
        if (first_reason.empty() && !reason.empty()) {
            first_reason = all[k].command.words.front() + ": " + reason;
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
    add_number(*command, "--slice", options->slice_seconds, 1e-3, 1e6,
               "Seconds that each runs before the next does");
    add_number(*command, "--seed", options->seed, 0, std::numeric_limits<std::uint64_t>::max(),
               "Of the order of the slices");
    command->callback([options] { processes(*options); });
}

} // namespace carom
