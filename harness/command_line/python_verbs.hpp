#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace carom {

/// Add the verbs of a group that Carom's Python packages do, so that help and completion know them.
void add_python_verbs(CLI::App& program, std::string_view group);

/// Becomes the Python program that does the verb which `words` begin with, as git becomes the program of a
/// verb; returns where that is a verb of this program, or none. Throws InputError where the packages or their
/// environment are not found: they lie two folders above this program's own, in a checkout as installed.
void hand_over(const std::vector<std::string>& words);

} // namespace carom
