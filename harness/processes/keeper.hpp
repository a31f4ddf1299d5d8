#pragma once

#include <nlohmann/json_fwd.hpp>
#include <sys/types.h>

#include "harness/processes/cgroup.hpp"
#include "harness/processes/process_command.hpp"

namespace carom {

/// A process between this one and a program. All that the program starts belongs to it: what loses its parent
/// becomes its child (PR_SET_CHILD_SUBREAPER, prctl(2)), so that it knows when the last of them has ended. It
/// reads what they print, and ends all of them when it is told to, or when this process is gone, however that
/// ended (keeping.hpp).
class Keeper {
  public:
    /// Starts it, and a process that waits to become the program. Throws InputError if there is no room for
    /// them, or if they do not answer.
    Keeper(const ProcessCommand& command, const Cgroup* group);

    /// Ends all of it.
    ~Keeper();
    Keeper(const Keeper&) = delete;
    Keeper& operator=(const Keeper&) = delete;

    /// Lets the program begin.
    void begin() const { tell('g'); }

    /// Has all of it ended that the program has started.
    void end_all() const { tell('k'); }

    /// Whether all has ended within so many seconds.
    bool await_end(double seconds) const;

    /// What it tells of that, once it has; null if it was ended itself and tells nothing. All of the program
    /// has ended then.
    nlohmann::ordered_json report();

    pid_t process() const { return process_; }

  private:
    void tell(char word) const;

    pid_t process_ = 0;
    int line_ = -1; ///< both ways; the keeper ends when this end is closed
};

} // namespace carom
