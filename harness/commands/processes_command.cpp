#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/command_line/described_process.hpp"
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
#include "harness/support/note.hpp"

namespace carom {
namespace {

using Json = nlohmann::ordered_json;

struct ProcessesOptions {
    std::string file;
    Together how;
};

/// One of them, with what is known of it before it runs and what it says of itself when it has.
struct AskedProcess {
    DescribedProcess described;
    Sources sources;
    std::vector<StatedTime> stated;
    int exit_code = 0; ///< of the last failure

    explicit AskedProcess(DescribedProcess its)
        : described(std::move(its)), sources(described.sources, described.written) {}
};

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
std::string take(AskedProcess& one, const ProcessEnd& end) {
    try {
        if (auto stated = stated_time(one.described, end)) {
            one.stated.push_back(*std::move(stated));
        }
    } catch (const InputError& error) {
        one.exit_code = 1;
        return error.what();
    }
    return "";
}

ProgramContender contender_of(AskedProcess& one) {
    ProgramContender contender = one.described.contender;
    contender.failure = [&one](const ProcessEnd& end) {
        std::string why = why_failed(one.described.contender.command, end, one.described.exit_codes);
        one.exit_code = exit_code_of(end);
        return why;
    };
    contender.take = [&one](const ProcessEnd& end) { return take(one, end); };
    return contender;
}

std::optional<ProcessTurns> turns_of(const Measured& measured, int contenders, std::uint64_t seed) {
    const bool took_turns = contenders > 1 && (measured.sliced || measured.runs.size() > 1);
    if (!took_turns) {
        return std::nullopt;
    }
    ProcessTurns turns{.contenders = contenders, .seed = seed, .seconds = {}};
    for (const ProcessEnd& run : measured.runs) {
        turns.seconds.insert(turns.seconds.end(), run.seconds.begin(), run.seconds.end());
    }
    return turns;
}

void write_record_of(const AskedProcess& one, const Measured& measured,
                     const std::optional<ProcessTurns>& turns) {
    const DescribedProcess& described = one.described;
    Json scene = nullptr;
    if (!described.scene.empty()) {
        const LoadedScene loaded = load_scene(described.scene);
        scene = scene_json(loaded.scene, loaded.name, loaded.sha256);
    }
    write_record(described.record, process_json({.command = described.contender.command,
                                                 .measured = measured,
                                                 .stated = one.stated,
                                                 .turns = turns,
                                                 .axes = described.axes,
                                                 .scene = scene,
                                                 .sources = one.sources,
                                                 .build = described.build,
                                                 .checked = described.checked,
                                                 .tags = described.tags,
                                                 .threads = described.threads,
                                                 .warm_ups = described.contender.warm_ups}));
}

/// In the place of the record of a process that failed.
void write_failure(const AskedProcess& one, const std::string& reason) {
    write_record(one.described.record, {{"schema_version", 1},
                                        {"kind", "failure"},
                                        {"tags", tags_json(one.described.tags)},
                                        {"axes", one.described.axes},
                                        {"command", one.described.contender.command.words},
                                        {"exit_code", one.exit_code == 0 ? 1 : one.exit_code},
                                        {"reason", reason},
                                        {"recorded_at", utc_now()}});
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

/// Leaves the record of a process that ended, or of its failure; returns why it failed, or nothing.
std::string keep(const AskedProcess& one, const Measured& measured,
                 const std::optional<ProcessTurns>& turns) {
    std::string reason = measured.failure;
    if (reason.empty()) {
        try {
            write_record_of(one, measured, turns);
            tell(one.described.contender.command.words.front(), measured);
        } catch (const InputError& error) {
            reason = error.what();
        }
    }
    if (!reason.empty()) {
        write_failure(one, reason);
    }
    return reason;
}

/// Times of unlike versions of a library are none of one kind: none of them counts.
void refuse_unlike_times(const std::vector<std::unique_ptr<AskedProcess>>& all,
                         std::vector<Measured>& measured) {
    for (std::size_t one = 0; one < all.size(); ++one) {
        for (std::size_t other = one + 1; other < all.size(); ++other) {
            if (all[one]->stated.empty() || all[other]->stated.empty()) {
                continue;
            }
            if (const auto why = unlike_times(all[one]->stated.back(), all[other]->stated.back())) {
                measured[one].failure = measured[other].failure = *why;
            }
        }
    }
}

void processes(const ProcessesOptions& options) {
    std::vector<std::unique_ptr<AskedProcess>> all;
    for (DescribedProcess& one : read_processes(options.file)) {
        all.push_back(std::make_unique<AskedProcess>(std::move(one)));
    }
    std::vector<ProgramContender> contenders;
    for (const auto& one : all) {
        contenders.push_back(contender_of(*one));
    }
    std::vector<Measured> measured = measure_together(contenders, options.how);
    refuse_unlike_times(all, measured);
    std::string first_reason;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const auto turns = turns_of(measured[k], static_cast<int>(all.size()), options.how.seed);
        const std::string reason = keep(*all[k], measured[k], turns);
        if (first_reason.empty() && !reason.empty()) {
            first_reason = all[k]->described.contender.command.words.front() + ": " + reason;
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
    add_number(*command, "--slice", options->how.slice_seconds, 1e-3, 1e6,
               "Seconds that the longest runs before the next does, the others in proportion; below "
               "some 0.02 the stops lengthen what is timed");
    add_number(*command, "--seed", options->how.seed, 0, std::numeric_limits<std::uint64_t>::max(),
               "Of the order of the slices");
    command->callback([options] { processes(*options); });
}

} // namespace carom
