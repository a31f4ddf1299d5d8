#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace carom {

/// Why a command line is refused, in one line: what an option's own validator says, or CLI11, whose releases
/// word it differently, with the help of the verb that was called.
std::string usage_message(const CLI::App& program, const CLI::ParseError& error);

/// Of the words that a verb could not place, the first that looks like an option and is none, as a message
/// with the nearest option; nothing if all are known. Options of Google Benchmark count as known.
std::optional<std::string> unknown_option(const CLI::App& verb, const std::vector<std::string>& words);

} // namespace carom
