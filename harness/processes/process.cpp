#include "harness/processes/process.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "harness/support/format.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/support/temporary_folder.hpp"

namespace carom {
namespace {

constexpr double most_seconds_to_stop = 0.1;

/// Somebody who looks at least so often ...
constexpr double look = 1;
/// ... and is late by so much was not let run.
constexpr double late = 1;

Printed printed_of(const nlohmann::ordered_json& json) {
    return {.bytes = json["bytes"], .end = json["end"]};
}

/// A process begins with the mark of memory of whoever forked it (setrlimit's ru_maxrss survives execve), so
/// that less than that, or hardly more, cannot be seen.
void set_memory(ProcessEnd& end, const nlohmann::ordered_json& report) {
    constexpr long hardly_more = 256;
    const long most = report["most_kilobytes"];
    const long inherited = report["inherited_kilobytes"];
    if (most > inherited + hardly_more) {
        end.peak_memory_bytes = std::int64_t{most} * 1024;
        end.memory_of = "the largest of its processes";
    } else {
        end.memory_of = format("no more than %.1f MB, which a process has from whoever starts it",
                               1024e-6 * static_cast<double>(inherited + hardly_more));
    }
}

} // namespace

Process::Process(ProcessCommand command, KeptBy kept_by)
    : command_(std::move(command)), tree_(make_tree(kept_by)),
      keeper_(std::make_unique<Keeper>(command_, tree_->group())) {
    tree_->set_keeper(keeper_->process());
    end_.kept_by = tree_->name();
}

void Process::begin() {
    has_begun_ = true;
    suspensions_.start();
    first_slice_began_ = process_seconds();
    keeper_->begin();
}

void Process::advance(double seconds) {
    const double began = process_seconds();
    if (has_begun_) {
        tree_->go_on();
    } else {
        begin();
        first_slice_began_ = began;
    }
    const double left = command_.most_seconds - end_.wall_seconds();
    double until = began + std::min(seconds, left);
    while (true) {
        const double before = process_seconds();
        const double step = std::clamp(until - before, 0.0, look);
        const bool all_ended = keeper_->await_end(step);
        const double overslept = process_seconds() - before - step;
        if (overslept > late) {
            end_.suspended =
                format("stood still for %.1f s while it was measured; measure it again", overslept);
        }
        if (all_ended) {
            take_report(began);
            return;
        }
        if (process_seconds() - began >= left) {
            end_it();
            take_report(began);
            return;
        }
        if (process_seconds() >= until) {
            const double asked = process_seconds();
            const bool stands_still = tree_->stop(most_seconds_to_stop);
            seconds_to_stop_ = process_seconds() - asked;
            if (stands_still) {
                break;
            }
            ++end_.ran_on;
            until = process_seconds() + std::min(seconds, left);
        }
    }
    end_.seconds.push_back(process_seconds() - began);
}

void Process::end_it() {
    constexpr double most_seconds_for_the_keeper = 5;
    end_.out_of_time = true;
    keeper_->end_all();
    if (!keeper_->await_end(most_seconds_for_the_keeper)) {
        tree_->kill();
    }
}

void Process::take_report(double slice_began) {
    const nlohmann::ordered_json report = keeper_->report();
    has_ended_ = true;
    end_.suspended = suspensions_.reason().value_or(end_.suspended);
    if (!report.is_object()) {
        tree_->kill();
        end_.unknown = "what looked after it was ended by somebody";
        return;
    }
    const int error = report["error"];
    if (error != 0) {
        end_.not_started = std::strerror(error);
        return;
    }
    if (!report["known"].get<bool>()) {
        end_.unknown = "the system does not tell";
    }
    if (const std::string left = report["left"]; !left.empty()) {
        end_.unknown = "it could not be ended: " + left;
    }
    end_.exit_code = report["exit_code"];
    end_.signal = report["signal"];
    end_.went_on = report["went_on"];
    end_.seconds_left_behind = report["seconds_left_behind"];
    end_.user_seconds = report["user_seconds"];
    end_.system_seconds = report["system_seconds"];
    end_.counted = report["counted"];
    end_.output = printed_of(report["output"]);
    end_.error = printed_of(report["error_output"]);
    set_memory(end_, report);
    // The keeper's clock is nearer to both ends than that of whoever waits for its word.
    const double ended = std::max(report["ended_at"].get<double>(), slice_began);
    end_.seconds.push_back(ended - slice_began);
    const double before_it_began = report["began_at"].get<double>() - first_slice_began_;
    end_.seconds.front() -= std::clamp(before_it_began, 0.0, end_.seconds.front());
    if (const Cgroup* const group = tree_->group()) {
        if (const auto cpu = group->cpu_time()) {
            end_.user_seconds = cpu->user;
            end_.system_seconds = cpu->system;
        }
        if (const auto waited = group->waited_seconds()) {
            end_.waited_seconds = std::max(0.0, *waited - report["waited_before"].get<double>());
        }
        if (const auto memory = group->peak_memory()) {
            end_.peak_memory_bytes = memory;
            end_.memory_of = "all of its processes together, with the files that they hold in memory";
        }
    }
}

ProcessEnd run_undisturbed(const ProcessCommand& command, KeptBy kept_by) {
    Process process(command, kept_by);
    process.advance(1e9);
    return process.end();
}

std::string version_line(const std::string& program) {
    const TemporaryFolder folder("carom-version-");
    const std::string file = folder / "printed";
    const ProcessEnd end =
        run_undisturbed({.words = {program, "--version"}, .output_file = file}, KeptBy::subreaper);
    const std::string printed = end.succeeded() ? read_file(file) : "";
    return printed.substr(0, printed.find('\n'));
}

} // namespace carom
