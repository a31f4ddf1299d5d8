#pragma once

#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace carom {

/// What a program wrote into one of its streams: not all of it, however much it was.
struct Printed {
    std::int64_t bytes = 0; ///< how many it wrote
    std::string end;        ///< the last of them
};

/// How a program ended with all that it had started, and what that took.
struct ProcessEnd {
    std::string not_started; ///< why it could not be run; empty if it could
    std::string unknown;     ///< why nobody knows how it ended; empty if that is known
    std::string suspended;   ///< how it is known that it stood still although nobody here wanted it to
    int exit_code = 0;
    int signal = 0; ///< the one that killed it, or 0
    bool out_of_time = false;
    std::string went_on; ///< the names of what it had started and that went on after its own end, if it
                         ///< ran out of time
    double seconds_left_behind = 0; ///< how long what it had started went on after its own end
    double user_seconds = 0;        ///< of CPU time, of all that it started
    double system_seconds = 0;
    std::optional<double> waited_seconds; ///< in which all of it that could run waited for a processor
    std::optional<std::int64_t> peak_memory_bytes; ///< of all together, or of the largest (see memory_of)
    std::string memory_of;                         ///< of what that is the peak, or why it is not known
    std::map<std::string, double> counted;         ///< by name: page faults, context switches, and what the
                                                   ///< hardware counts (event_counts.hpp)
    std::vector<double> seconds;                   ///< wall time of each slice in which it was let run
    int ran_on = 0;                                ///< slices that were longer since it did not stand still
    std::string kept_by;                           ///< what kept all of it together: cgroup or subreaper
    Printed output;
    Printed error;

    double wall_seconds() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }
    /// Less what it waited for a processor, as far as that is known.
    double own_seconds() const { return wall_seconds() - waited_seconds.value_or(0); }
    double cpu_seconds() const { return user_seconds + system_seconds; }

    /// Whether it is known to have ended by itself, with exit code 0.
    bool succeeded() const {
        return not_started.empty() && unknown.empty() && !out_of_time && signal == 0 && exit_code == 0;
    }
};

} // namespace carom
