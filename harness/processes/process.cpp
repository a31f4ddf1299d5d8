#include "harness/processes/process.hpp"

#include <algorithm>
#include <csignal>
#include <numeric>
#include <utility>

#include <unistd.h>

#include "harness/processes/descendants.hpp"
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

} // namespace

Process::Process(ProcessCommand command, std::unique_ptr<Cgroup> group)
    : command_(std::move(command)), group_(std::move(group)),
      keeper_(std::make_unique<Keeper>(command_, group_.get())) {}

void Process::begin() {
    has_begun_ = true;
    suspensions_.start();
    first_slice_began_ = process_seconds();
    keeper_->begin();
}

double Process::wall_seconds() const { return std::accumulate(seconds_.begin(), seconds_.end(), 0.0); }

/// By signals: what is between vfork and exec cannot stop before its child has gone on, so that nothing is
/// waited for without a limit, and not at all where one runs as another user. Whoever is found later may have
/// been started before its parent stood still.
bool Process::stop() {
    if (group_ != nullptr) {
        return group_->stop(most_seconds_to_stop);
    }
    const double begin = process_seconds();
    while (true) {
        const std::vector<pid_t> all = descendants_of(keeper_->process());
        const bool still = std::ranges::all_of(all, stands_still);
        if (still && all == stopped_) {
            return true;
        }
        const bool all_reached = send_signal(all, SIGSTOP).empty();
        stopped_ = all;
        if (!all_reached || process_seconds() - begin > most_seconds_to_stop) {
            go_on();
            return false;
        }
        usleep(still ? 0 : 50);
    }
}

void Process::go_on() {
    if (group_ != nullptr) {
        group_->go_on();
        return;
    }
    send_signal(descendants_of(keeper_->process()), SIGCONT);
    stopped_.clear();
}

void Process::kill_all() const {
    if (group_ != nullptr) {
        group_->kill();
    } else {
        send_signal(descendants_of(keeper_->process()), SIGKILL);
    }
}

void Process::advance(double seconds) {
    const double began = process_seconds();
    if (has_begun_) {
        go_on();
    } else {
        begin();
        first_slice_began_ = began;
    }
    const double left = command_.most_seconds - wall_seconds();
    double until = began + std::min(seconds, left);
    while (true) {
        const double before = process_seconds();
        const double step = std::clamp(until - before, 0.0, look);
        const bool all_ended = keeper_->await_end(step);
        const double overslept = process_seconds() - before - step;
        if (overslept > late) {
            facts_["suspended"] =
                format("stood still for %.1f s while it was measured; measure it again", overslept);
        }
        if (!all_ended && process_seconds() - began >= left) {
            constexpr double most_seconds_for_the_keeper = 5;
            facts_["out_of_time"] = true;
            keeper_->end_all();
            if (!keeper_->await_end(most_seconds_for_the_keeper)) {
                kill_all();
            }
        }
        if (all_ended || facts_["out_of_time"].get<bool>()) {
            take_report(began);
            return;
        }
        if (process_seconds() >= until) {
            const double asked = process_seconds();
            const bool stands_still = stop();
            seconds_to_stop_ = process_seconds() - asked;
            if (stands_still) {
                break;
            }
            ++ran_on_;
            until = process_seconds() + std::min(seconds, left);
        }
    }
    seconds_.push_back(process_seconds() - began);
}

void Process::take_report(double slice_began) {
    const nlohmann::ordered_json report = keeper_->report();
    has_ended_ = true;
    if (report.is_object()) {
        const auto so_far = std::exchange(facts_, report["facts"]);
        facts_["suspended"] = so_far["suspended"];
        facts_["out_of_time"] = so_far["out_of_time"];
    } else {
        kill_all();
        facts_["unknown"] = "what looked after it was ended by somebody";
    }
    if (report.is_object() && facts_["not_started"] == "") {
        // The keeper's clock is nearer to both ends than that of whoever waits for its word.
        const double ended = std::max(report["ended_at"].get<double>(), slice_began);
        seconds_.push_back(ended - slice_began);
        const double before_it_began = report["began_at"].get<double>() - first_slice_began_;
        seconds_.front() -= std::clamp(before_it_began, 0.0, seconds_.front());
    }
    facts_["suspended"] = suspensions_.reason().value_or(facts_["suspended"].get<std::string>());
    facts_["seconds"] = seconds_;
    facts_["ran_on"] = ran_on_;
    facts_["tree"] = group_ != nullptr ? "cgroup" : "subreaper";
}

nlohmann::ordered_json run_undisturbed(const ProcessCommand& command, std::unique_ptr<Cgroup> group) {
    Process process(command, std::move(group));
    process.advance(1e9);
    return process.facts();
}

std::string version_line(const std::string& program) {
    const TemporaryFolder folder("carom-version-");
    const std::string file = folder / "printed";
    const auto facts = run_undisturbed({.words = {program, "--version"}, .output_file = file}, nullptr);
    const std::string printed = succeeded(facts) ? read_file(file) : "";
    return printed.substr(0, printed.find('\n'));
}

} // namespace carom
