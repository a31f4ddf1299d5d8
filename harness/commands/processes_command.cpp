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
