#include "harness/commands/help.hpp"

#include <cstddef>
#include <sstream>
#include <utility>

namespace carom {
namespace {

constexpr std::size_t columns = 80;

/// Breaks one line at its spaces; what follows a break is indented by so many columns.
std::string wrapped(std::string line, std::size_t indent) {
    std::string text;
    while (line.size() > columns) {
        std::size_t end = line.rfind(' ', columns);
        if (end == std::string::npos || end <= indent) {
            end = line.find(' ', columns);
        }
        if (end == std::string::npos) {
            break;
        }
        text += line.substr(0, end) + '\n';
        line = std::string(indent, ' ') + line.substr(end + 1);
    }
    return text + line + '\n';
}

} // namespace

std::string WrappedHelp::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
    std::istringstream lines(CLI::Formatter::make_help(app, std::move(name), mode));
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        text += wrapped(line, line.starts_with(' ') ? get_column_width() : 0);
    }
    return text;
}

} // namespace carom
