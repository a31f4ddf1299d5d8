#pragma once

#include <CLI/CLI.hpp>

namespace carom {

/// Each adds one verb of the program with its options. The verb runs as the callback of its subcommand: it
/// prints its result on standard output and throws one of the errors of harness/support/errors.hpp.
void add_help_command(CLI::App& program);
void add_list_command(CLI::App& program);
void add_run_command(CLI::App& program);
void add_check_command(CLI::App& program);
void add_bench_command(CLI::App& program);
void add_turns_command(CLI::App& program);
void add_processes_command(CLI::App& program);
void add_profile_command(CLI::App& program);
void add_generate_command(CLI::App& program);
void add_reference_command(CLI::App& program);
void add_doctor_command(CLI::App& program);
void add_limits_command(CLI::App& program);

} // namespace carom
