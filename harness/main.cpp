#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <new>

#include <CLI/CLI.hpp>

#include "harness/command_line/help.hpp"
#include "harness/command_line/usage_errors.hpp"
#include "harness/commands/commands.hpp"
#include "harness/machine/waiting.hpp"
#include "harness/support/errors.hpp"

namespace {

int fail(int code, const char* message) {
    std::cout.flush();
    std::fprintf(stderr, "carom: %s\n", message);
    return code;
}

void add_verbs(CLI::App& program) {
    carom::add_list_command(program);
    carom::add_run_command(program);
    carom::add_check_command(program);
    carom::add_bench_command(program);
    carom::add_turns_command(program);
    carom::add_processes_command(program);
    carom::add_profile_command(program);
    carom::add_generate_command(program);
    carom::add_reference_command(program);
    carom::add_doctor_command(program);
    carom::add_limits_command(program);
    carom::add_outside_command(program);
    carom::add_promises_command(program);
    carom::add_help_command(program);
    program.footer(
        "Exit codes: 0 done; 1 wrong usage or bad input, told in one line; 2 a result failed its check; "
        "3 this build has not what was asked for. A scene of `-` is read from standard input.");
}

} // namespace

int main(int count, char** arguments) {
    carom::settle_waiting();
    // A file that may not grow further is then told as a full disk is, in one line.
    std::signal(SIGXFSZ, SIG_IGN);
    // Whoever started this may ignore it, and the system would not tell how a child ended.
    std::signal(SIGCHLD, SIG_DFL);
    CLI::App program("Carom: a performance study of colliding discs that checks itself", "carom");
    program.formatter(std::make_shared<carom::Help>());
    program.require_subcommand(1);
    program.set_version_flag("--version", "carom " CAROM_VERSION, "Print the version and exit");
    program.set_help_all_flag("--help-all", "Print the help of every verb");
    add_verbs(program);
    try {
        if (count > 1 && arguments[1][0] != '-') {
            carom::require_verb(program, arguments[1]);
        }
        program.parse(count, arguments);
        if (!std::cout.flush()) {
            return fail(1, "standard output: writing broke off, expected room");
        }
        return 0;
    } catch (const CLI::Success& help) {
        return program.exit(help);
    } catch (const CLI::ParseError& error) {
        return fail(1, carom::usage_message(program, error).c_str());
    } catch (const carom::InputError& error) {
        return fail(1, error.what());
    } catch (const carom::CheckError& error) {
        return fail(2, error.what());
    } catch (const carom::NotBuiltIn& error) {
        return fail(3, error.what());
    } catch (const std::bad_alloc&) {
        return fail(1, "out of memory: expected a machine with room for the scene and its boxes");
    } catch (const std::exception& error) {
        return fail(1, error.what());
    }
}
