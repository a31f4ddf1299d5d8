#include <iostream>
#include <memory>
#include <regex>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "harness/command_line/help.hpp"
#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"

namespace carom {
namespace {

/// Prints the verbs and options that the help on standard input tells of.
constexpr const char* reading_help = R"script(_carom_words() {
    "$@" --help 2>/dev/null | awk '
        /^ *-/ { for (i = 1; i <= 3; ++i) if (match($i, /^--[a-z][a-z-]*/)) print substr($i, 1, RLENGTH) }
        /^  (  )?[a-z][a-z_-]*  / { print $1 }'
}
)script";

constexpr const char* for_bash = R"script(
_carom() {
    local command=("$1") candidates
    ((COMP_CWORD > 1)) && command+=("${COMP_WORDS[1]}")
    ((COMP_CWORD > 2)) && [[ ${COMP_WORDS[1]} == study ]] && command+=("${COMP_WORDS[2]}")
    if [[ $3 == --variant ]]; then
        candidates="auto fastest $("$1" list --names 2>/dev/null)"
    else
        candidates=$(_carom_words "${command[@]}")
    fi
    mapfile -t COMPREPLY < <(compgen -W "$candidates" -- "$2")
}
complete -o default -F _carom carom
)script";

constexpr const char* for_zsh = R"script(
_carom() {
    local -a command=($words[1])
    ((CURRENT > 2)) && command+=($words[2])
    ((CURRENT > 3)) && [[ $words[2] == study ]] && command+=($words[3])
    if [[ $words[CURRENT-1] == --variant ]]; then
        compadd -- auto fastest ${(f)"$($words[1] list --names 2>/dev/null)"}
    else
        compadd -- ${(f)"$(_carom_words $command)"}
        _files
    fi
}
if [[ $funcstack[1] == _carom ]]; then
    _carom "$@"
else
    compdef _carom carom
fi
)script";

/// The script with which a shell, `bash` or `zsh`, completes a command line of this program. It reads what
/// can follow from the help of the verb at hand, so that both always agree.
std::string completion(const std::string& shell) {
    return shell == "bash" ? std::string(reading_help) + for_bash
                           : "#compdef carom\n" + std::string(reading_help) + for_zsh;
}

/// A text as roff takes it: nothing in it is a request.
std::string escaped(std::string text) {
    for (const auto& [found, shown] :
         {std::pair(R"(\\)", R"(\e)"), {"-", R"(\-)"}, {"(^|\n)([.'])", R"($1\&$2)"}}) {
        text = std::regex_replace(text, std::regex(found), shown);
    }
    return text;
}

/// The page of the program for man(7): what it does, and the help of each verb that its own help lists.
std::string man_page(const CLI::App& program) {
    std::string text = ".TH CAROM 1 \"\" \"carom " CAROM_VERSION "\"\n.SH NAME\ncarom \\- " +
                       escaped(program.get_description()) +
                       "\n.SH SYNOPSIS\n.B carom\nVERB [OPTIONS]\n.SH VERBS\n";
    const auto is_listed = [](const CLI::App* verb) { return verb->get_group() != groups::none; };
    for (const CLI::App* verb : program.get_subcommands(is_listed)) {
        text += ".SS carom " + escaped(verb->get_name()) + "\n.nf\n" +
                escaped(verb->help(program.get_name())) + ".fi\n";
    }
    return text + ".SH EXIT STATUS\n" + escaped(program.get_footer()) + "\n";
}

struct HelpOptions {
    std::string verb;
    std::string shell;
    bool man = false;
};

void print_help(CLI::App& program, const HelpOptions& options) {
    if (options.man) {
        std::cout << man_page(program);
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
