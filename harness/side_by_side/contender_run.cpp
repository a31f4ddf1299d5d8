#include "harness/side_by_side/contender_run.hpp"

#include <algorithm>
#include <cstring>

#include "harness/support/errors.hpp"
#include "harness/support/format.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

/// Some programs end at once where nobody can type, or read what they draw.
constexpr const char* without_a_word =
    " without a word; it had no terminal: its standard input is empty, its outputs are pipes";

std::string name_of_signal(int signal) {
    const char* const name = sigabbrev_np(signal);
    return name != nullptr ? std::string("SIG") + name : "signal " + std::to_string(signal);
}

} // namespace

std::string why_failed(const ProcessCommand& command, const ProcessEnd& end, const std::vector<int>& fine) {
    const std::string said = last_line(end.error.end);
    const std::string after = said.empty() ? "" : ": " + said;
    if (!end.not_started.empty()) {
        return "cannot be run" + (command.folder.empty() ? "" : " in " + command.folder) + ": " +
               end.not_started;
    }
    if (!end.suspended.empty()) {
        return end.suspended;
    }
    if (end.out_of_time) {
        const std::string limit = format("took longer than %g s", command.most_seconds) +
                                  (end.unknown.empty() ? " and was stopped" : "; " + end.unknown);
        return end.went_on.empty()
                   ? limit
                   : limit + "; it had ended, and what it had started went on: " + end.went_on;
    }
    if (!end.went_on.empty()) {
        return "left " + end.went_on + " running in the background, expected nothing beside what is timed";
    }
    if (!end.unknown.empty()) {
        return "nobody knows how it ended: " + end.unknown;
    }
    if (end.signal != 0) {
        return "killed by " + name_of_signal(end.signal) + after;
    }
    if (std::ranges::find(fine, end.exit_code) == fine.end()) {
        return format("exit code %d%s", end.exit_code, said.empty() ? without_a_word : after.c_str());
    }
    return "";
}

int exit_code_of_failure(const ProcessEnd& end) {
    if (end.out_of_time) {
        return 124;
    }
    if (end.signal != 0) {
        return -end.signal;
    }
    return end.not_started.empty() ? std::max(end.exit_code, 1) : 127;
}

ContenderRun::ContenderRun(const ProgramContender& contender)
    : contender_(contender), folder_(contender.command.folder) {
    if (contender.fresh_folder) {
        folder_ = fresh_.emplace("carom-run-").path();
    }
    failure_ = run_beside("prepare", contender.prepare);
    if (failure_.empty()) {
        ProcessCommand command = contender.command;
        command.folder = folder_;
        process_ = std::make_unique<Process>(command);
    }
}

ContenderRun::~ContenderRun() {
    process_.reset();
    if (!is_concluded_) {
        try {
            conclude();
        } catch (const InputError&) {
            // There is no room for a process: whatever comes next says so.
        }
    }
}

std::string ContenderRun::conclude() {
    is_concluded_ = true;
    if (process_ != nullptr) {
        failure_ = contender_.failure(process_->end());
    }
    const std::string not_concluded = run_beside("conclude", contender_.conclude);
    fresh_.reset();
    return failure_.empty() ? not_concluded : failure_;
}

std::string ContenderRun::run_beside(const std::string& what, const std::vector<std::string>& words) const {
    if (words.empty()) {
        return "";
    }
    const ProcessCommand command{.words = words,
                                 .folder = folder_,
                                 .environment = contender_.command.environment,
                                 .most_seconds = contender_.command.most_seconds,
                                 .most_seconds_behind = 2};
    const std::string why = why_failed(command, run_undisturbed(command), {0});
    return why.empty() ? "" : what + ": " + why;
}

} // namespace carom
