#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace carom {

/// CLI11's help with no line wider than a terminal of 80 columns: what is longer goes on below its own
/// column.
class WrappedHelp final : public CLI::Formatter {
  public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

} // namespace carom
