#include "harness/command_line/python_verbs.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <unistd.h>

#include "harness/command_line/help.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

struct PythonVerb {
    const char* name;
    const char* group;
    const char* package;    ///< that does it, or a part of one
    bool is_word;           ///< the package takes the verb's name as a word
    bool takes_the_program; ///< the package is told where this program is
    const char* told;
};

constexpr std::array python_verbs{
    PythonVerb{"compare", groups::measure, "experiments.compare", true, false,
               "Run commands in turns until it is settled which is faster"},
    PythonVerb{"gate", groups::measure, "experiments.compare", true, false,
               "Tell by an exit code whether a commit is slower than another"},
    PythonVerb{"movie", groups::simulate, "analysis", true, true,
               "Draw a run as an animation, or one step of it"},
    PythonVerb{"study", groups::study, "experiments", false, false,
               "Plan, run and look after a study, here or on a cluster; has verbs of its own"},
    PythonVerb{"report", groups::study, "analysis", true, false, "Write the report of whatever was measured"},
    PythonVerb{"claims", groups::study, "analysis", true, false, "Print each claim with its verdict"},
    PythonVerb{"export", groups::study, "analysis", true, false,
               "Write a CSV table with a row a measurement"},
    PythonVerb{"figures", groups::study, "analysis", true, false,
               "Draw the figures of whatever was measured"},
};

/// The program's own file, all links followed.
std::filesystem::path own_file() {
    std::error_code error;
    std::filesystem::path file = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) {
        throw InputError("/proc/self/exe: " + error.message() + ", expected the program's own file");
    }
    return file;
}

/// What becomes of `words`. The packages are found by the environment that they are installed in; what the
/// user has for Python, a folder of that name or PYTHONPATH, is left alone (-I).
std::vector<std::string> python_words(const PythonVerb& verb, const std::vector<std::string>& words) {
    const std::filesystem::path root = own_file().parent_path().parent_path().parent_path();
    const std::filesystem::path python = root / ".venv" / "bin" / "python";
    const std::string_view module = verb.package;
    const std::string_view package = module.substr(0, module.find('.'));
    for (const std::filesystem::path& part : {python, root / ".venv" / "lib", root / package}) {
        if (access(part.c_str(), R_OK | X_OK) != 0) {
            throw InputError(
                std::string(verb.name) + ": needs Carom's Python parts, " +
                (errno == EACCES
                     ? "of which you may not read " + part.string() + ", expected them open to you"
                     : "which are not in " + root.string() +
                           ", expected there as in a checkout after `make setup`, or installed"));
        }
    }
    std::vector<std::string> all{python.string(), "-I", "-m", verb.package};
    all.insert(all.end(), words.begin() + (verb.is_word ? 0 : 1), words.end());
    if (verb.takes_the_program) {
        all.insert(all.end(), {"--program", own_file().string()});
    }
    return all;
}

} // namespace

void add_python_verbs(CLI::App& program, std::string_view group) {
    for (const PythonVerb& verb : python_verbs) {
        if (verb.group == group) {
            program.add_subcommand(verb.name, verb.told)->prefix_command()->group(verb.group);
        }
    }
}

void hand_over(const std::vector<std::string>& words) {
    const bool asks_help = words.size() > 1 && words.front() == "help";
    const std::string name = words.empty() ? "" : words[asks_help ? 1 : 0];
    const auto* const verb = std::ranges::find(python_verbs, name, &PythonVerb::name);
    if (verb == python_verbs.end()) {
        return;
    }
    std::vector<std::string> all =
        python_words(*verb, asks_help ? std::vector<std::string>{words[1], "--help"} : words);
    std::vector<char*> pointers;
    for (std::string& word : all) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    // Python would tell of a signal that comes while it starts as of a fault: these packages let it in.
    if (std::string_view(verb->package).starts_with("experiments")) {
        sigset_t all;
        sigfillset(&all);
        sigprocmask(SIG_BLOCK, &all, nullptr);
    }
    execv(pointers.front(), pointers.data());
    throw InputError(std::string(verb->name) + ": " + all.front() +
                     " cannot be started: " + std::strerror(errno));
}

} // namespace carom
