#include "harness/processes/descendants.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <map>
#include <sstream>
#include <string_view>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include "harness/support/text.hpp"

namespace carom {
namespace {

/// What a file of /proc holds; empty if the process is gone.
std::string text_of(const std::string& path) {
    std::array<char, 4096> buffer;
    std::string text;
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    for (ssize_t count = 0; (count = read(file, buffer.data(), buffer.size())) > 0;) {
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    close(file);
    return text;
}

std::string folder_of(pid_t process) { return "/proc/" + std::to_string(process); }

/// What follows a process's name in its `stat`, which may hold any letters itself: state, parent ...; empty
/// if the process is gone.
std::string after_name(pid_t process) {
    const std::string stat = text_of(folder_of(process) + "/stat");
    const auto end = stat.rfind(')');
    return end == std::string::npos || end + 2 > stat.size() ? "" : stat.substr(end + 2);
}

/// Whether the letter of a process's state is one of these, or the process is gone.
bool is_gone_or(std::string_view states, pid_t process) {
    const std::string state = after_name(process);
    return state.empty() || states.find(state.front()) != std::string_view::npos;
}

/// Appends the numbers that stand in a row, each with a blank behind it.
void append_numbers(std::string_view text, std::vector<pid_t>& numbers) {
    for (std::size_t end = 0; (end = text.find(' ')) != std::string_view::npos; text.remove_prefix(end + 1)) {
        numbers.push_back(parse_number<pid_t>(text.substr(0, end)).value_or(0));
    }
}

/// What the names of a folder's entries are numbers of; none if the folder is gone.
std::vector<pid_t> numbers_in(const std::string& folder) {
    std::vector<pid_t> numbers;
    DIR* const listing = opendir(folder.c_str());
    if (listing == nullptr) {
        return numbers;
    }
    while (const dirent* const entry = readdir(listing)) {
        if (const auto number = parse_number<pid_t>(entry->d_name)) {
            numbers.push_back(*number);
        }
    }
    closedir(listing);
    return numbers;
}

/// Where the kernel tells the children of each thread (CONFIG_PROC_CHILDREN).
bool tells_children() {
    static const bool tells = access("/proc/thread-self/children", R_OK) == 0;
    return tells;
}

std::vector<pid_t> children_of(pid_t process) {
    std::vector<pid_t> children;
    const std::string threads = folder_of(process) + "/task/";
    for (const pid_t thread : numbers_in(threads)) {
        append_numbers(text_of(threads + std::to_string(thread) + "/children"), children);
    }
    return children;
}

std::multimap<pid_t, pid_t> all_by_parent() {
    std::multimap<pid_t, pid_t> by_parent;
    for (const pid_t process : numbers_in("/proc")) {
        std::istringstream rest(after_name(process));
        char state = 0;
        pid_t parent = 0;
        if (rest >> state >> parent) {
            by_parent.emplace(parent, process);
        }
    }
    return by_parent;
}

} // namespace
std::vector<pid_t> descendants_of(pid_t root) {
    std::vector<pid_t> found;
    const auto by_parent = tells_children() ? std::multimap<pid_t, pid_t>() : all_by_parent();
    std::vector<pid_t> open_ends{root};
    while (!open_ends.empty()) {
        const pid_t parent = open_ends.back();
        open_ends.pop_back();
        std::vector<pid_t> children = tells_children() ? children_of(parent) : std::vector<pid_t>();
        const auto [begin, end] = by_parent.equal_range(parent);
        for (auto one = begin; one != end; ++one) {
            children.push_back(one->second);
        }
        for (const pid_t child : children) {
            open_ends.push_back(child);
            if (!is_gone_or("ZX", child)) {
                found.push_back(child);
            }
        }
    }
    return found;
}

std::vector<pid_t> send_signal(std::vector<pid_t> processes, int signal) {
    std::erase_if(processes, [signal](pid_t one) { return kill(one, signal) == 0 || errno != EPERM; });
    return processes;
}

bool stands_still(pid_t process) { return is_gone_or("TtZX", process); }

std::string name_of(pid_t process) {
    const std::string text = text_of(folder_of(process) + "/comm");
    const std::string name = text.substr(0, text.find('\n'));
    return name.empty() ? number_text(process) : name;
}

std::string names_of(const std::vector<pid_t>& processes) {
    std::string names;
    for (const pid_t one : processes) {
        names += (names.empty() ? "" : ", ") + name_of(one);
    }
    return names;
}

} // namespace carom
