#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/processes/process.hpp"
#include "harness/side_by_side/program_contender.hpp"
#include "harness/support/temporary_folder.hpp"

namespace carom {

/// One run of a contender, with what is to be done before and after it.
class ContenderRun {
  public:
    /// Makes its folder, if it has one of its own, and runs what prepares it. Throws InputError where there
    /// is no room for either.
    explicit ContenderRun(const ProgramContender& contender);

    /// Ends what is left of it, and concludes it.
    ~ContenderRun();
    ContenderRun(const ContenderRun&) = delete;
    ContenderRun& operator=(const ContenderRun&) = delete;

    /// Whether there is a process, to be advanced to its end; there is none if what prepares it failed.
    bool can_run() const { return process_ != nullptr; }
    Process& process() { return *process_; }

    /// Once it has ended: runs what concludes it and removes its folder. Returns why the run failed, or
    /// nothing.
    std::string conclude();

  private:
    std::string run_beside(const std::string& what, const std::vector<std::string>& words) const;

    const ProgramContender& contender_;
    std::string folder_;
    std::optional<TemporaryFolder> fresh_; ///< its own folder, if it has one
    std::string failure_;
    bool is_concluded_ = false;
    std::unique_ptr<Process> process_;
};

/// Why a run of `words` does not count for whoever wants it to succeed: it was not started, was killed, took
/// too long, ended with an exit code that is none of `fine`, or nobody knows. Empty if it does count.
std::string why_failed(const ProcessCommand& command, const ProcessEnd& end, const std::vector<int>& fine);

/// The exit code of a run that failed, never 0: its own, 1 where that is 0, 124 where it took too long (as of
/// timeout(1)), 127 where it cannot be run (as of a shell), the signal that killed it below 0.
int exit_code_of_failure(const ProcessEnd& end);

} // namespace carom
