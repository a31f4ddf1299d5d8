#include "harness/command_line/help.hpp"

#include <iostream>
#include <memory>
#include <string>

#include "harness/commands/commands.hpp"

namespace carom {

void add_help_command(CLI::App& program) {
    auto verb = std::make_shared<std::string>();
    CLI::App* command = program.add_subcommand("help", "Print the help of a verb, or of the program");
    command->add_option("VERB", *verb, "A verb; without one, the program");
    command->callback([&program, verb] {
        const std::string name = program.get_name();
        const auto form = program.get_formatter();
        std::cout << (verb->empty() ? form->make_help(&program, name, CLI::AppFormatMode::Normal)
                                    : require_verb(program, *verb).help(name));
    });
}

} // namespace carom
