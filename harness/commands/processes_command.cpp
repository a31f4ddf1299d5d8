#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <unistd.h>

#include "harness/commands/commands.hpp"
#include "harness/commands/measurement_options.hpp"
#include "harness/machine/noise.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/processes/priority.hpp"
#include "harness/records/record.hpp"
#include "harness/side_by_side/slices.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/json.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

/// Of what a program prints, enough to know what kind of program it is.
constexpr std::size_t end_told = 4096;

/// The time that all processors together have had nothing to do since the machine was started, in seconds; 0
/// where the system does not tell it.
double idle_seconds_of_machine() {
    const auto cpu = read_cpu_time();
    return cpu ? cpu->idle / static_cast<double>(sysconf(_SC_CLK_TCK)) : 0;
}

ProcessCommand command_of(const Json& json) {
    json.at("command").at(0); // throws where there is no word
    ProcessCommand command{.words = json.at("command")};
    command.folder = json.value("folder", command.folder);
    command.most_seconds = json.value("most_seconds", command.most_seconds);
    command.most_seconds_behind = json.value("most_seconds_behind", command.most_seconds_behind);
    command.output_file = json.value("output_file", command.output_file);
    const auto more = json.value("environment", std::map<std::string, std::string>());
    std::erase_if(command.environment,
                  [&more](const auto& own) { return more.contains(own.substr(0, own.find('='))); });
    for (const auto& [name, value] : more) {
        command.environment.push_back(name);
        command.environment.back() += '=' + value;
    }
    return command;
}

Json facts_of(const Sliced& run, double idle_seconds) {
    const ProcessEnd& end = run.process->end();
    const std::string& printed = end.output.end;
    return {{"seconds", end.seconds},
            {"seconds_alone", run.seconds_alone},
            {"idle_seconds", idle_seconds},
            {"not_started", end.not_started},
            {"unknown", end.unknown},
            {"suspended", end.suspended},
            {"exit_code", end.exit_code},
            {"signal", end.signal},
            {"out_of_time", end.out_of_time},
            {"went_on", end.went_on},
            {"seconds_left_behind", end.seconds_left_behind},
            {"user_seconds", end.user_seconds},
            {"system_seconds", end.system_seconds},
            {"waited_seconds", or_null(end.waited_seconds)},
            {"peak_memory_bytes", or_null(end.peak_memory_bytes)},
            {"memory_of", end.memory_of},
            {"counted", end.counted},
            {"ran_on", end.ran_on},
            {"tree", end.kept_by},
            {"output_bytes", end.output.bytes},
            {"error_bytes", end.error.bytes},
            {"output_end", printed.substr(printed.size() - std::min(printed.size(), end_told))},
            {"error_end", last_line(end.error.end)}};
}

/// Runs all of a plan's processes in turn, one without a pause; what became of each, in their order.
Json run(const Json& plan) {
    std::deque<Process> processes;
    std::vector<Sliced> all;
    for (const Json& one : plan.at("processes")) {
        all.push_back({.process = &processes.emplace_back(command_of(one)),
                       .expected_seconds = one.value("expected_seconds", 0.0)});
    }
    const double idle_before = idle_seconds_of_machine();
    take_slices(all, plan.value("slice_seconds", 1.0), plan.value("seed", std::uint64_t{0}));
    const double idle = idle_seconds_of_machine() - idle_before;
    Json told = Json::array();
    for (const Sliced& one : all) {
        told.push_back(facts_of(one, idle));
    }
    return told;
}

/// What a record says of the machine and of a scene, which may be null.
Json surroundings(const Json& asked) {
    Json scene;
    if (const Json path = asked.value("scene", Json()); path.is_string()) {
        const LoadedScene loaded = load_scene(path);
        scene = scene_json(loaded.scene, loaded.name, loaded.sha256);
    }
    return {{"provenance", provenance_json(asked.at("threads"))}, {"scene", scene}};
}

void processes() {
    run_at_once();
    for (std::string line; std::getline(std::cin, line);) {
        try {
            const Json asked = Json::parse(line);
            std::cout << json_text(asked.contains("processes") ? run(asked) : surroundings(asked), -1)
                      << std::endl;
        } catch (const Json::exception&) {
            throw InputError("standard input: found " + in_quotes(line) +
                             ", expected an object of JSON in each line: processes, or threads");
        }
    }
}

} // namespace

void add_processes_command(CLI::App& program) {
    program
        .add_subcommand(
            "processes",
            "Time whole processes of any programs from outside, side by side in slices of time: "
            "for each line of JSON on standard input, those to be run, a line of what became of them")
        ->callback(processes);
}

} // namespace carom
