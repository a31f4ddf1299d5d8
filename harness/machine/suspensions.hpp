#pragma once

#include <optional>
#include <string>

namespace carom {

/// Notices that this process stood still for a while, so that a time with a pause in it is not taken for a
/// measurement.
///
/// Noticed is a stop by a signal (Ctrl-Z, `kill -STOP`, SUSPEND of Slurm), however short, since SIGCONT must
/// follow it; a SIGCONT without a stop is taken for one. Noticed is a machine that slept, since
/// CLOCK_BOOTTIME goes on then and CLOCK_MONOTONIC does not (man clock_gettime).
///
/// Not noticed is what sends no signal: a frozen control group (cgroup.freeze, `docker pause`), a debugger,
/// and a virtual machine that its host stops.
class Suspensions {
  public:
    /// Looks from now on, and forgets what was before. From the first call on this process handles SIGCONT,
    /// and the calling thread does not block it.
    void start();

    bool noticed() const;

    /// "was suspended for some time while it was measured; measure it again", or nothing if none was noticed.
    std::optional<std::string> reason() const;

    /// Throws InputError with `name` and the reason, if one was noticed.
    void require_none(const std::string& name) const;

  private:
    int continued_ = 0;
    double asleep_seconds_ = 0;
};

} // namespace carom
