#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace carom {

/// The page of the program for man(7), made of the same text as its help: what it does, its verbs by group,
/// and of each verb its arguments and options.
std::string man_page(const CLI::App& program, const std::string& version);

} // namespace carom
