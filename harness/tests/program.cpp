#include "harness/tests/program.hpp"

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <sstream>

#include <sys/wait.h>

#include "harness/tests/temporary_directory.hpp"

namespace carom::tests {
namespace {

/// A word as a shell takes it.
std::string quoted(const std::string& word) {
    return " '" + std::regex_replace(word, std::regex("'"), R"('\'')") + "'";
}

} // namespace

ProgramResult run_carom(std::vector<std::string> arguments, const std::vector<std::string>& environment,
                        const std::string& standard_output, const std::string& standard_input) {
    const TemporaryDirectory directory;
    const std::string output = standard_output.empty() ? directory / "output" : standard_output;
    // The program takes as many threads as it is told to, however busy the machine, unless a setting says
    // else.
    std::string missing;
    std::string set = " OMP_DYNAMIC=false";
    for (const std::string& setting : environment) {
        if (setting.find('=') == std::string::npos) {
            missing += " -u" + quoted(setting);
            set = setting == "OMP_DYNAMIC" ? "" : set;
        } else {
            set += quoted(setting);
        }
    }
    std::string command = "exec env" + missing + set;
    arguments.insert(arguments.begin(), CAROM_PROGRAM);
    for (const std::string& argument : arguments) {
        command += quoted(argument);
    }
    command += " <" + quoted(standard_input) + " >" + quoted(output) + " 2>" + quoted(directory / "error");
    const int status = std::system(command.c_str());
    ProgramResult result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    result.output = standard_output.empty() ? content_of(output) : "";
    std::istringstream lines(content_of(directory / "error"));
    for (std::string line; std::getline(lines, line);) {
        const bool ended = !lines.eof();
        (line.starts_with("carom: note: ") ? result.notes : result.error) += line + (ended ? "\n" : "");
    }
    return result;
}

testing::AssertionResult refused(const ProgramResult& result, int exit_code,
                                 const std::vector<std::string>& parts) {
    const bool is_one_line = result.error.ends_with('\n') && std::ranges::count(result.error, '\n') == 1;
    const auto lacks = std::ranges::find_if(
        parts, [&](const std::string& part) { return result.error.find(part) == std::string::npos; });
    if (result.exit_code == exit_code && result.output.empty() && is_one_line && lacks == parts.end()) {
        return testing::AssertionSuccess();
    }
    return testing::AssertionFailure()
           << "exit code " << result.exit_code << ", standard output '" << result.output
           << "', standard error '" << result.error << "': expected exit code " << exit_code
           << ", nothing on standard output, and one line on standard error"
           << (lacks == parts.end() ? "" : " with '" + *lacks + "'");
}

} // namespace carom::tests
