#include <iostream>
#include <memory>
#include <string>

#include "harness/command_line/completion.hpp"
#include "harness/command_line/help.hpp"
#include "harness/command_line/man_page.hpp"
#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"

namespace carom {
namespace {

struct HelpOptions {
    std::string verb;
    std::string shell;
    bool man = false;
};

void print_help(CLI::App& program, const HelpOptions& options) {
    if (options.man) {
        std::cout << man_page(program, CAROM_VERSION);
    } else if (!options.shell.empty()) {
        std::cout << completion(options.shell);
    } else if (!options.verb.empty()) {
        std::cout << require_verb(program, options.verb).help(program.get_name());
    } else {
        std::cout << program.get_formatter()->make_help(&program, program.get_name(),
                                                        CLI::AppFormatMode::Normal);
    }
}

} // namespace

void add_help_command(CLI::App& program) {
    auto options = std::make_shared<HelpOptions>();
    CLI::App* command = program.add_subcommand("help", "Print the help of a verb, or of the program");
    command->add_option("VERB", options->verb, "A verb; without one, the program");
    command->add_flag("--man", options->man, "Print the page for man instead");
    command->add_option("--completion", options->shell, "Print what completes commands in a shell instead")
        ->check(one_of({"bash", "zsh"}));
    command->callback([&program, options] { print_help(program, *options); });
}

} // namespace carom
