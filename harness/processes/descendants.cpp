#include "harness/processes/descendants.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "harness/support/text.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;

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

/// The names in a folder of /proc that are numbers; none if it is gone.
std::vector<pid_t> numbers_in(const std::string& folder) {
    std::vector<pid_t> numbers;
    std::error_code gone;
    for (fs::directory_iterator entry(folder, gone); !gone && entry != fs::directory_iterator();
         entry.increment(gone)) {
        if (const auto number = parse_number<pid_t>(entry->path().filename().string())) {
            numbers.push_back(*number);
        }
    }
    return numbers;
}

} // namespace

std::vector<pid_t> children_by_thread(pid_t parent) {
    std::vector<pid_t> children;
    const std::string threads = folder_of(parent) + "/task/";
    for (const pid_t thread : numbers_in(threads)) {
        std::istringstream numbers(text_of(threads + std::to_string(thread) + "/children"));
        children.insert(children.end(), std::istream_iterator<pid_t>(numbers), {});
    }
    return children;
}

std::vector<pid_t> children_by_parent(pid_t parent) {
    std::vector<pid_t> children = numbers_in("/proc");
    std::erase_if(children, [parent](pid_t one) {
        std::istringstream rest(after_name(one));
        char state = 0;
        pid_t its_parent = 0;
        return !(rest >> state >> its_parent) || its_parent != parent;
    });
    return children;
}

std::vector<pid_t> descendants_of(pid_t root) {
    static const bool tells_children = access("/proc/thread-self/children", R_OK) == 0;
    std::vector<pid_t> found;
    std::vector<pid_t> open_ends{root};
    while (!open_ends.empty()) {
        const pid_t parent = open_ends.back();
        open_ends.pop_back();
        for (const pid_t child : tells_children ? children_by_thread(parent) : children_by_parent(parent)) {
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
