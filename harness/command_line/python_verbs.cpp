#include "harness/command_line/python_verbs.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <unistd.h>

#include "harness/command_line/help.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

/// A verb, the package that does it, whether that takes the verb's name as a word, and what it is for.
struct PythonVerb {
    const char* name;
    const char* package;
    bool is_word;
    const char* told;
};

constexpr std::array python_verbs{
    PythonVerb{"movie", "analysis", true, "Draw a run as an animation, or one step of it"},
    PythonVerb{"study", "experiments", false,
               "Plan, run and look after a study, here or on a cluster; has verbs of its own"},
    PythonVerb{"report", "analysis", true, "Write the report of whatever was measured"},
    PythonVerb{"claims", "analysis", true, "Print each claim with its verdict"},
    PythonVerb{"figures", "analysis", true, "Draw the figures of whatever was measured"},
};

constexpr const PythonVerb& movie = python_verbs[0];

const PythonVerb* find_verb(std::string_view name) {
    const auto* const found =
        std::ranges::find_if(python_verbs, [name](const PythonVerb& verb) { return name == verb.name; });
    return found == python_verbs.end() ? nullptr : found;
}

void add_verb(CLI::App& program, const PythonVerb& verb) {
    program.add_subcommand(verb.name, verb.told)->prefix_command();
}

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
    if (access(python.c_str(), X_OK) != 0 || !std::filesystem::is_directory(root / verb.package)) {
        throw InputError(std::string(verb.name) + ": needs Carom's Python parts, which are not in " +
                         root.string() +
                         ", expected there as in a checkout after `make setup`, or installed");
    }
    std::vector<std::string> all{python.string(), "-I", "-m", verb.package};
    all.insert(all.end(), words.begin() + (verb.is_word ? 0 : 1), words.end());
    if (&verb == &movie) {
        all.insert(all.end(), {"--program", own_file().string()});
    }
    return all;
}

} // namespace

void add_movie_command(CLI::App& program) { add_verb(program, movie); }

void add_study_commands(CLI::App& program) {
    for (const PythonVerb& verb : python_verbs) {
        if (&verb != &movie) {
            add_verb(program, verb);
        }
    }
}

void hand_over(const std::vector<std::string>& words) {
    const bool asks_help = words.size() > 1 && words.front() == "help";
    const PythonVerb* const verb = words.empty() ? nullptr : find_verb(words[asks_help ? 1 : 0]);
    if (verb == nullptr) {
        return;
    }
    std::vector<std::string> all =
        python_words(*verb, asks_help ? std::vector<std::string>{words[1], "--help"} : words);
    std::vector<char*> pointers;
    for (std::string& word : all) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    execv(pointers.front(), pointers.data());
    throw InputError(std::string(verb->name) + ": " + all.front() +
                     " cannot be started: " + std::strerror(errno));
}

} // namespace carom
