#include "harness/tests/program.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/tests/temporary_directory.hpp"

namespace carom::tests {
namespace {

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    pointers.reserve(texts.size() + 1);
    for (std::string& text : texts) {
        pointers.push_back(text.data());
    }
    pointers.push_back(nullptr);
    return pointers;
}

std::string name_of(const std::string& setting) { return setting.substr(0, setting.find('=')); }

/// Without a setting of its own the program takes as many threads as it is told to, however busy the machine.
std::vector<std::string> environment_with(std::vector<std::string> settings) {
    const auto names_it = [](const auto& setting) { return name_of(setting) == "OMP_DYNAMIC"; };
    if (std::ranges::none_of(settings, names_it)) {
        settings.emplace_back("OMP_DYNAMIC=false");
    }
    std::vector<std::string> all;
    std::ranges::copy_if(settings, std::back_inserter(all),
                         [](const auto& setting) { return setting.find('=') != std::string::npos; });
    for (char** entry = environ; *entry != nullptr; ++entry) {
        const std::string name = name_of(*entry);
        if (std::ranges::none_of(settings,
                                 [&name](const auto& setting) { return name_of(setting) == name; })) {
            all.emplace_back(*entry);
        }
    }
    return all;
}

/// Parts what the program wrote to standard error into notes and the rest.
void part(const std::string& text, ProgramResult& result) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const bool ended = !lines.eof();
        (line.starts_with("carom: note: ") ? result.notes : result.error) += line + (ended ? "\n" : "");
    }
}

} // namespace

ProgramResult run_carom(std::vector<std::string> arguments, const std::vector<std::string>& environment,
                        const std::string& standard_output, const std::string& standard_input) {
    const TemporaryDirectory directory;
    const std::string output = standard_output.empty() ? directory / "output" : standard_output;
    const std::string error = directory / "error";
    arguments.insert(arguments.begin(), CAROM_PROGRAM);
    std::vector<std::string> settings = environment_with(environment);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, standard_input.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, error.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
    pid_t process = 0;
    const int failure = posix_spawn(&process, CAROM_PROGRAM, &actions, nullptr, pointers_to(arguments).data(),
                                    pointers_to(settings).data());
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) {
        throw std::system_error(failure, std::generic_category(), CAROM_PROGRAM);
    }
    int status = 0;
    while (waitpid(process, &status, 0) < 0) {
    }
    ProgramResult result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    result.output = standard_output.empty() ? content_of(output) : "";
    part(content_of(error), result);
    return result;
}

testing::AssertionResult refused(const ProgramResult& result, int exit_code,
                                 const std::vector<std::string>& parts) {
    const auto failure = [&result] {
        return testing::AssertionFailure() << "exit code " << result.exit_code << ", standard output '"
                                           << result.output << "', standard error '" << result.error << "': ";
    };
    if (result.exit_code != exit_code) {
        return failure() << "expected exit code " << exit_code;
    }
    if (!result.output.empty()) {
        return failure() << "expected nothing on standard output";
    }
    if (!result.error.ends_with('\n') || std::ranges::count(result.error, '\n') != 1) {
        return failure() << "expected one line on standard error";
    }
    for (const std::string& part : parts) {
        if (result.error.find(part) == std::string::npos) {
            return failure() << "expected '" << part << "' on standard error";
        }
    }
    return testing::AssertionSuccess();
}

} // namespace carom::tests
