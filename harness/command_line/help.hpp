#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace carom {

/// What the verbs of the program are for, in the order of its help. What has no group is called by the study
/// alone: it can be called, and only `--help-all` tells of it.
namespace groups {
inline constexpr const char* measure = "Measure your programs";
inline constexpr const char* simulate = "Simulate";
inline constexpr const char* study = "The study";
inline constexpr const char* machine = "This machine";
inline constexpr const char* none = "";
} // namespace groups

/// The help of the program or of a verb: CLI11's, with what an option needs behind what it does, and with the
/// whole help of every verb if all is asked for. No line is wider than a terminal of 80 columns: what is
/// longer goes on below its own column.
class Help final : public CLI::Formatter {
  public:
    Help();
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
    std::string make_subcommands(const CLI::App* app, CLI::AppFormatMode mode) const override;
    std::string make_option(const CLI::Option* option, bool is_argument) const override;
};

/// The verb of that name. Throws InputError, with the nearest one, if there is none.
CLI::App& require_verb(CLI::App& program, const std::string& name);

} // namespace carom
