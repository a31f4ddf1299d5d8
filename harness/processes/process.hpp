#pragma once

#include <memory>
#include <string>

#include "harness/machine/suspensions.hpp"
#include "harness/processes/keeper.hpp"
#include "harness/processes/process_command.hpp"
#include "harness/processes/process_end.hpp"
#include "harness/processes/tree.hpp"

namespace carom {

/// A program with all that it starts, let run and stopped slice by slice, timed from outside: from the moment
/// at which it becomes the program to the end of the last process of all. It ends with whoever started it,
/// whole, however that ends.
class Process {
  public:
    /// Nothing of it runs yet. Throws InputError if there is no room for it.
    explicit Process(ProcessCommand command, KeptBy kept_by = KeptBy::whatever_works);

    /// Lets it begin and waits for nothing. What it does before it is first advanced is not timed.
    void begin();

    /// Lets it begin or go on for so many seconds or to its end; then it stands still. What does not stand
    /// still within a tenth of a second goes on for as long again. What has used up its time is ended.
    void advance(double seconds);

    bool has_ended() const { return has_ended_; }

    /// How long it took, at the end of its last slice, until it was known to stand still.
    double seconds_to_stop() const { return seconds_to_stop_; }

    /// How it ended, once it has.
    const ProcessEnd& end() const { return end_; }

  private:
    void end_it();
    void take_report(double slice_began);

    ProcessCommand command_;
    std::unique_ptr<Tree> tree_;
    std::unique_ptr<Keeper> keeper_;
    bool has_begun_ = false;
    bool has_ended_ = false;
    double first_slice_began_ = 0;
    double seconds_to_stop_ = 0;
    Suspensions suspensions_;
    ProcessEnd end_;
};

/// Runs it to its end without a pause.
ProcessEnd run_undisturbed(const ProcessCommand& command, KeptBy kept_by = KeptBy::whatever_works);

/// The first line that a program prints of its version; empty if it is not on PATH, or fails. Throws
/// InputError if there is no room for a process.
std::string version_line(const std::string& program);

} // namespace carom
