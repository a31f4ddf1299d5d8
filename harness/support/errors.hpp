#pragma once

#include <stdexcept>

namespace carom {

/// Wrong usage or bad input: one line that says where, what was found and what was expected. Exit code 1.
class InputError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A result that is wrong, or a resolve that does not end: one line that names it. Exit code 2.
class CheckError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace carom
