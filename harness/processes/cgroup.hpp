#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "harness/processes/tree.hpp"

namespace carom {

/// CPU time in seconds.
struct UserAndSystem {
    double user;
    double system;
};

/// A control group (cgroups v2) of its own for a program and all that it starts, whatever group or session
/// that belongs to: it can be stopped, also in the middle of a vfork, and ended as one (the Linux kernel's
/// Documentation/admin-guide/cgroup-v2.rst: cgroup.freeze, cgroup.kill).
class Cgroup : public Tree {
  public:
    /// A new and empty one; none where there is no such hierarchy, or no right to make a group in it: it
    /// takes root, or a folder that was delegated, as systemd does to users.
    static std::unique_ptr<Cgroup> make();

    /// Ends all that is left in it.
    ~Cgroup() override;
    Cgroup(const Cgroup&) = delete;
    Cgroup& operator=(const Cgroup&) = delete;

    /// A file: the process that writes "0" into it belongs to the group from then on.
    int entrance() const { return entrance_; }

    const std::string& path() const { return path_; }

    bool stop(double most_seconds) override;
    void go_on() override;
    void kill() const override;
    const Cgroup* group() const override { return this; }
    std::string name() const override { return "cgroup"; }

    /// Of all that was ever in it, also of what nobody waited for.
    std::optional<UserAndSystem> cpu_time() const;

    /// How long nothing of it ran although something could have: what it waited for a processor. None where
    /// the system does not tell (PSI).
    std::optional<double> waited_seconds() const;

    /// Of all of it together; none where the group does not account for memory.
    std::optional<std::int64_t> peak_memory() const;

  private:
    Cgroup(std::string path, int entrance, int events);

    std::string path_;
    int entrance_;
    int events_;
};

} // namespace carom
