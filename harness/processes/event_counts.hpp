#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace carom {

/// An event of the kernel's generic ones (perf_event_open(2)).
struct CountedEvent {
    std::string_view name;
    unsigned int type;
    unsigned long long config;
};

/// Opens it for a process, to be counted in user mode, or in the kernel as well, from the moment at which it
/// becomes another program on, with all that it starts. Returns a descriptor, or -1 and errno says why.
int open_event(const CountedEvent& event, pid_t process, bool in_kernel = false);

/// Instructions, cycles, cache misses and wrong guesses of branches, in user mode.
const std::vector<CountedEvent>& hardware_events();

/// Counts events of a program with all that it starts, from the moment at which it becomes the program to the
/// end of the last of them: PAPI cannot begin at that moment.
class EventCounts {
  public:
    /// For a process that has not become its program yet. What this machine does not count is left out.
    explicit EventCounts(pid_t process, const std::vector<CountedEvent>& events = hardware_events());
    ~EventCounts();
    EventCounts(const EventCounts&) = delete;
    EventCounts& operator=(const EventCounts&) = delete;

    /// What was counted, by name, once all have ended; without an event that had to share its counter with
    /// another one, since nothing is extrapolated.
    std::map<std::string, double> read() const;

  private:
    struct Open {
        std::string_view name;
        int descriptor;
    };
    std::vector<Open> open_;
};

} // namespace carom
