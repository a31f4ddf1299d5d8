#pragma once

#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace carom {

/// A control group (cgroups v2) of its own for a program and all that it starts, whatever group or session
/// that belongs to: it can be stopped, also in the middle of a vfork, and ended as one (the Linux kernel's
/// Documentation/admin-guide/cgroup-v2.rst: cgroup.freeze, cgroup.kill).
class Cgroup {
  public:
    /// A new and empty one; none where there is no such hierarchy, or no right to make a group in it: it
    /// takes root, or a folder that was delegated, as systemd does to users.
    static std::unique_ptr<Cgroup> make();

    /// Ends all that is left in it.
    ~Cgroup();
    Cgroup(const Cgroup&) = delete;
    Cgroup& operator=(const Cgroup&) = delete;

    /// A file: the process that writes "0" into it belongs to the group from then on.
    int entrance() const { return entrance_; }

    const std::string& path() const { return path_; }

    /// Whether all of it stands still within so many seconds. If not, all of it goes on.
    bool stop(double most_seconds) const;
    void go_on() const;

    /// Ends all of it.
    void kill() const;

    /// How long nothing of it ran although something could have: what it waited for a processor. None where
    /// the system does not tell (PSI).
    std::optional<double> waited_seconds() const;

    /// Puts what the group tells into the facts of a run: CPU time of all that was ever in it, also of what
    /// nobody waited for; how long that waited, but for so many seconds before the run; the peak of memory of
    /// all of it together. What it does not account for stays as it is.
    void tell(nlohmann::ordered_json& facts, double waited_before) const;

  private:
    Cgroup(std::string path, int entrance, int events);

    std::string path_;
    int entrance_;
    int events_;
};

} // namespace carom
