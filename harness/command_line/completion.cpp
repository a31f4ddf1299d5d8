#include "harness/command_line/completion.hpp"

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

} // namespace

std::string completion(const std::string& shell) {
    return shell == "bash" ? std::string(reading_help) + for_bash
                           : "#compdef carom\n" + std::string(reading_help) + for_zsh;
}

} // namespace carom
