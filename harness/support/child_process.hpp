#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace carom {

/// How a program ended that this one started.
struct ChildEnd {
    bool started = false;  ///< false if there is no such program on PATH
    bool is_known = false; ///< false if the system does not tell how it ended
    int exit_code = 0;
    int signal = 0;     ///< the one that killed it, or 0
    std::string output; ///< standard output and standard error, as they came

    bool succeeded() const { return started && is_known && exit_code == 0 && signal == 0; }
};

/// Of a long output about so many bytes are kept from its beginning and as many from its end.
inline constexpr std::size_t kept_output = std::size_t{64} << 10;

/// Runs a program, found on PATH, with its arguments and no shell, its standard input empty, and waits for
/// it. Throws InputError if the system has no room for another process.
ChildEnd run_child(const std::vector<std::string>& command);

/// The last line of a text that is not blank.
std::string last_line(const std::string& text);

} // namespace carom
