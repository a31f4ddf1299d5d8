#include "harness/processes/descendants.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string_view>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include "harness/support/text.hpp"

namespace carom {
namespace {

/// The beginning of a file of /proc, which is short; empty if the process is gone.
std::string beginning_of(const std::string& path) {
    std::array<char, 4096> buffer;
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        return "";
    }
    std::string text;
    for (ssize_t count = 0; (count = read(file, buffer.data(), buffer.size())) > 0;) {
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    close(file);
    return text;
}

std::string folder_of(pid_t process) { return "/proc/" + std::to_string(process); }

/// What follows a process's name in its `stat`, which may hold any letters itself: state, parent ...
std::string after_name(pid_t process) {
    const std::string stat = beginning_of(folder_of(process) + "/stat");
    const auto end = stat.rfind(')');
    return end == std::string::npos || end + 2 > stat.size() ? "" : stat.substr(end + 2);
}

bool has_ended(pid_t process) {
    const std::string state = after_name(process);
    return state.empty() || state.front() == 'Z' || state.front() == 'X';
}

std::vector<std::string> numbers_in(const std::string& folder) {
    std::vector<std::string> names;
    DIR* const listing = opendir(folder.c_str());
    if (listing == nullptr) {
        return names;
    }
    while (const dirent* const entry = readdir(listing)) {
        if (entry->d_name[0] >= '0' && entry->d_name[0] <= '9') {
            names.emplace_back(entry->d_name);
        }
    }
    closedir(listing);
    return names;
}

void append_numbers(const std::string& text, std::vector<pid_t>& numbers) {
    const char* place = text.c_str();
    for (char* end = nullptr; *place != '\0'; place = end) {
        const long number = std::strtol(place, &end, 10);
        if (end == place) {
            return;
        }
        numbers.push_back(static_cast<pid_t>(number));
    }
}

/// Where the kernel tells the children of each thread (CONFIG_PROC_CHILDREN).
bool tells_children() {
    static const bool tells =
        access((folder_of(getpid()) + "/task/" + std::to_string(getpid()) + "/children").c_str(), R_OK) == 0;
    return tells;
}

std::vector<pid_t> children_of(pid_t process) {
    std::vector<pid_t> children;
    const std::string threads = folder_of(process) + "/task";
    for (const std::string& thread : numbers_in(threads)) {
        append_numbers(beginning_of(threads + "/" + thread + "/children"), children);
    }
    return children;
}

std::multimap<pid_t, pid_t> all_by_parent() {
    std::multimap<pid_t, pid_t> by_parent;
    for (const std::string& name : numbers_in("/proc")) {
        const auto process = static_cast<pid_t>(std::atol(name.c_str()));
        const std::string rest = after_name(process);
        if (rest.size() > 2) {
            by_parent.emplace(static_cast<pid_t>(std::atol(rest.c_str() + 2)), process);
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
            if (!has_ended(child)) {
                found.push_back(child);
            }
        }
    }
    return found;
}

bool stands_still(pid_t process) {
    const std::string state = after_name(process);
    return state.empty() || std::string_view("TtZX").find(state.front()) != std::string_view::npos;
}

std::string name_of(pid_t process) {
    std::string name = beginning_of(folder_of(process) + "/comm");
    while (!name.empty() && name.back() == '\n') {
        name.pop_back();
    }
    return name.empty() ? number_text(process) : name;
}

} // namespace carom
