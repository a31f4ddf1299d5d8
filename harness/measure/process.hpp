#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <sys/types.h>

namespace carom {

/// A program to be run as it is: no shell sees its words.
struct ProcessCommand {
    std::vector<std::string> words;       ///< the program, with a slash or to be found on PATH; its arguments
    std::string folder;                   ///< that it runs in; empty: this process's own
    std::vector<std::string> environment; ///< NAME=VALUE, all that it sees
    double most_seconds = 600;            ///< of its own running time; what takes longer is killed
};

/// How a process ended, and what it took.
struct ProcessEnd {
    std::string not_started; ///< why it could not be run; empty if it could
    int exit_code = 0;
    int signal = 0; ///< the one that killed it, or 0
    bool out_of_time = false;
    double user_seconds = 0; ///< of CPU time, its finished children's included
    double system_seconds = 0;
    std::int64_t peak_memory_bytes = 0; ///< resident, of the largest of it and its children
    std::vector<double> seconds;        ///< wall time of each slice in which it was let run
    std::string output;                 ///< its standard output
    std::string error;                  ///< its standard error

    double wall_seconds() const;
};

/// A process in a group of its own, let run and stopped slice by slice, timed from outside. It ends with
/// whoever started it, and its whole group with it.
class Process {
  public:
    /// Throws InputError if there is no room for what it will print.
    explicit Process(ProcessCommand command);
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    /// Starts it, or lets it go on, for so many seconds or to its end; then it stands still. The slice that
    /// starts it begins before it exists. What cannot be started has ended. Throws InputError if the system
    /// has no means to wait for a process.
    void advance(double seconds);

    bool has_ended() const { return has_ended_; }

    /// Throws InputError if what it printed cannot be read back.
    ProcessEnd end() const;

  private:
    void start();
    pid_t spawn(int report);
    void await_end(double seconds);
    void stop();
    void take_leave();
    void kill_group();

    ProcessCommand command_;
    std::FILE* output_;
    std::FILE* error_;
    pid_t child_ = 0;
    int ends_ = -1; ///< a descriptor that is readable once it has ended
    bool has_ended_ = false;
    ProcessEnd end_;
};

/// Runs all of them to their ends in turn: in each round, in an order that is drawn anew, each of those that
/// have not ended runs for `slice_seconds`, while the others stand still. One alone is never stopped.
///
/// What disturbs the machine for longer than a round disturbs all alike (as in turns.hpp). A process notices
/// nothing but that the clock on the wall runs faster than its own work.
void take_slices(std::vector<Process*> processes, double slice_seconds, std::uint64_t seed);

} // namespace carom
