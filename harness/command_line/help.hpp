#pragma once

#include <string>
#include <vector>

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

/// The help of the program or of a verb, laid out here and not by CLI11, whose releases differ: what it does,
/// how to call it, its arguments and options with what they take and their defaults. No line is wider than a
/// terminal of 80 columns: what is longer goes on below its own column.
class Help final : public CLI::FormatterBase {
  public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

/// An argument, an option or a verb as it is typed, and what is told of it.
struct HelpEntry {
    std::string left;
    std::string right;
};

/// What the help of a verb tells of, in its order.
std::vector<HelpEntry> arguments_of(const CLI::App& verb);
std::vector<HelpEntry> options_of(const CLI::App& verb);

/// "carom run [OPTIONS] SCENE [THREADS]".
std::string usage_of(const CLI::App& app, const std::string& name);

/// The verbs of one of the `groups`.
std::vector<const CLI::App*> verbs_of(const CLI::App& program, const std::string& group);

/// The verb of that name. Throws InputError, with the nearest one, if there is none.
CLI::App& require_verb(CLI::App& program, const std::string& name);

} // namespace carom
