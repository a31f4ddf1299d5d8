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
        command.environment.push_back(std::string(name).append("=").append(value));
    }
    return command;
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
        told.push_back(one.process->facts());
        told.back().update({{"seconds_alone", one.seconds_alone}, {"idle_seconds", idle}});
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
