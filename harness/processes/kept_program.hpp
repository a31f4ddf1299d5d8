#pragma once

#include <sys/types.h>

#include "harness/processes/process_command.hpp"

namespace carom {

/// What a keeper and the process that will become the program tell each other, in memory that both see.
struct Beginning {
    long inherited_kilobytes = 0; ///< the mark of memory that the program inherits from who forked it
    double at = 0;                ///< by `process_seconds` of the keeper, whose fork it is
    int error = 0;                ///< why it could not become the program
};

/// The keeper's ends of the pipes to the program.
struct ProgramPipes {
    int go = -1;     ///< a byte lets the program begin
    int begun = -1;  ///< comes to its end when the program has begun, or could not
    int output = -1; ///< the program's standard output
    int error = -1;  ///< its standard error
};

/// Forks the process that waits to become the program; -1 if that cannot be. It enters the group whose file
/// `entrance` is, if that is no -1, and dies with its keeper.
pid_t fork_program(const ProcessCommand& command, int entrance, Beginning& beginning, ProgramPipes& pipes);

} // namespace carom
