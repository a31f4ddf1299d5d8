#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace carom {

/// The help of the program or of a verb, laid out here and not by CLI11, whose releases differ: what it does,
/// how to call it, its arguments and options with what they take and their defaults. No line is wider than a
/// terminal of 80 columns: what is longer goes on below its own column.
class Help final : public CLI::FormatterBase {
  public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

/// The verb of that name. Throws InputError, with the nearest one, if there is none.
CLI::App& require_verb(CLI::App& program, const std::string& name);

} // namespace carom
