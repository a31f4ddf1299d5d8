#pragma once

#include <memory>
#include <string>

#include <sys/types.h>

namespace carom {

class Cgroup;

/// What is to keep together all that a program starts.
enum class KeptBy {
    whatever_works, ///< a control group where one can be had
    subreaper,      ///< signals to each process below a keeper, to which orphans fall (prctl(2))
};

/// All that a program has started, which can be stopped, let go on and ended.
class Tree {
  public:
    virtual ~Tree() = default;

    /// Says below which process the program is; before anything is stopped.
    virtual void set_keeper(pid_t /*keeper*/) {}

    /// Whether all of it stands still within so many seconds. If not, all of it goes on.
    virtual bool stop(double most_seconds) = 0;
    virtual void go_on() = 0;

    /// Ends all of it that can be ended at once.
    virtual void kill() const = 0;

    /// The group that a new process is to enter; none where there is no group.
    virtual const Cgroup* group() const { return nullptr; }

    virtual std::string name() const = 0;
};

std::unique_ptr<Tree> make_tree(KeptBy kept_by);

} // namespace carom
