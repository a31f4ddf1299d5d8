#include <csignal>
#include <cstdio>
#include <exception>
#include <initializer_list>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/command_line/help.hpp"
#include "harness/command_line/python_verbs.hpp"
#include "harness/command_line/usage_errors.hpp"
#include "harness/commands/commands.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/machine/threads.hpp"
#include "harness/machine/waiting.hpp"
#include "harness/support/errors.hpp"

namespace {

int fail(int code, const char* message) {
    std::cout.flush();
    std::fprintf(stderr, "carom: %s\n", message);
    return code;
}

using AddVerb = void (*)(CLI::App&);

void add_group(CLI::App& program, const char* group, std::initializer_list<AddVerb> verbs) {
    for (const AddVerb add : verbs) {
        add(program);
        program.get_subcommands(nullptr).back()->group(group);
    }
}

void add_verbs(CLI::App& program) {
    using namespace carom;
    add_python_verbs(program, groups::measure);
    add_group(
        program, groups::simulate,
        {add_run_command, add_check_command, add_reference_command, add_generate_command, add_list_command});
    add_python_verbs(program, groups::simulate);
    add_python_verbs(program, groups::study);
    add_group(program, groups::machine,
              {add_doctor_command, add_limits_command, add_bench_command, add_profile_command});
    add_group(program, groups::none, {add_turns_command, add_processes_command, add_help_command});
    program.footer(
        "Exit codes: 0 done; 1 wrong usage or bad input, told in one line; 2 a result failed its check. "
        "A scene of `-` is read from standard input.");
}

} // namespace

int main(int count, char** arguments) {
    carom::settle_waiting();
    carom::end_where_threads_run_out_of_memory();
    try {
        carom::hand_over(std::vector<std::string>(arguments + (count > 0 ? 1 : 0), arguments + count));
    } catch (const carom::InputError& error) {
        return fail(1, error.what());
    }
    // A file that may not grow further is then told as a full disk is, in one line.
    std::signal(SIGXFSZ, SIG_IGN);
    CLI::App program("Carom: a performance study of colliding discs that checks itself", "carom");
    program.formatter(std::make_shared<carom::Help>());
    program.require_subcommand(1);
    program.set_version_flag("--version", "carom " CAROM_VERSION " (" + carom::commit_text() + ")",
                             "Print the version and the commit that it was built from, and exit");
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
    } catch (const carom::CheckError& error) {
        return fail(2, error.what());
    } catch (const std::bad_alloc&) {
        return fail(1, "out of memory: expected a machine with room for the scene and its boxes");
    } catch (const std::exception& error) {
        return fail(1, error.what());
    }
}
