#pragma once

#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/types.h>

#include "harness/machine/suspensions.hpp"
#include "harness/processes/cgroup.hpp"
#include "harness/processes/keeper.hpp"
#include "harness/processes/process_command.hpp"
#include "harness/processes/process_facts.hpp"

namespace carom {

/// A program with all that it starts, let run and stopped slice by slice, timed from outside: from the moment
/// at which it becomes the program to the end of the last process of all. It ends with whoever started it,
/// whole, however that ends.
class Process {
  public:
    /// Nothing of it runs yet. What keeps together all that it starts is a control group, or, without one,
    /// signals to each process below a keeper, to which orphans fall (prctl(2)). Throws InputError if there
    /// is no room for it.
    explicit Process(ProcessCommand command, std::unique_ptr<Cgroup> group = Cgroup::make());

    /// Lets it begin and waits for nothing. What it does before it is first advanced is not timed.
    void begin();

    /// Lets it begin or go on for so many seconds or to its end; then it stands still. What does not stand
    /// still within a tenth of a second goes on for as long again. What has used up its time is ended.
    void advance(double seconds);

    bool has_ended() const { return has_ended_; }

    /// In which it was let run so far.
    double wall_seconds() const;

    /// How long it took, at the end of its last slice, until it was known to stand still.
    double seconds_to_stop() const { return seconds_to_stop_; }

    /// How it ended, once it has (process_facts.hpp).
    const nlohmann::ordered_json& facts() const { return facts_; }

  private:
    bool stop();
    void go_on();
    void kill_all() const;
    void take_report(double slice_began);

    ProcessCommand command_;
    std::unique_ptr<Cgroup> group_;
    std::unique_ptr<Keeper> keeper_;
    std::vector<pid_t> stopped_; ///< told to stop by a signal, and still there when it was last looked
    bool has_begun_ = false;
    bool has_ended_ = false;
    double first_slice_began_ = 0;
    std::vector<double> seconds_; ///< of each slice
    double seconds_to_stop_ = 0;
    int ran_on_ = 0; ///< slices that were longer since it did not stand still
    Suspensions suspensions_;
    nlohmann::ordered_json facts_ = no_facts();
};

/// The facts of a run to its end without a pause.
nlohmann::ordered_json run_undisturbed(const ProcessCommand& command,
                                       std::unique_ptr<Cgroup> group = Cgroup::make());

/// The first line that a program prints of its version; empty if it is not on PATH, or fails. Throws
/// InputError if there is no room for a process.
std::string version_line(const std::string& program);

} // namespace carom
