#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace carom {

/// Why a command line is refused, in one line of the program's own: CLI11's releases word it differently.
/// What is wrong is found out from the options of the verb that was called, and only for what is found
/// nowhere from the error's text.
std::string usage_message(const CLI::App& program, const CLI::ParseError& error);

/// Of the words that a verb could not place, the first that looks like an option and is none, as a message
/// with the nearest option; nothing if all are known. Options of Google Benchmark count as known.
std::optional<std::string> unknown_option(const CLI::App& verb, const std::vector<std::string>& words);

} // namespace carom
