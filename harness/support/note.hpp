#pragma once

#include <cstdio>
#include <iostream>
#include <string>

namespace carom {

/// One line on standard error that is no error: the program goes on, or has done what it was asked for.
inline void note(const std::string& text) {
    std::cout.flush();
    std::fflush(stdout);
    std::fprintf(stderr, "carom: note: %s\n", text.c_str());
}

} // namespace carom
