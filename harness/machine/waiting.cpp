#include "harness/machine/waiting.hpp"

#include <utility>

#include "harness/support/note.hpp"

// GNU's runtime, libgomp, reads its settings from the environment before main, and before any object of the
// program is made. Only functions of .preinit_array run earlier: before all libraries, the C library among
// them, whose functions cannot be called there. The environment cannot grow then, but an entry can be
// exchanged: until main, the setting stands in the place of one that no library asks for. To start the
// program a second time with the setting would be the plain way. It costs 7 ms, as much as the first start
// (200 starts in turns), which no clock in the program would tell, and valgrind does not follow it.

/// LLVM's runtime, where the program is linked with it. It is told while it runs (machine/threads.hpp).
extern "C" [[gnu::weak]] void kmp_set_blocktime(int milliseconds); // NOLINT(readability-*)

namespace carom {
namespace {

/// How often a thread looks before it sleeps (docs/performance.md).
char setting[] = "GOMP_SPINCOUNT=2000";

bool is_wanted = false;
char** changed_entry = nullptr;
char* entry_before = nullptr;

/// Where `text` goes on after `start`, or nothing if it does not start so.
constexpr const char* after(const char* text, const char* start) {
    for (; *start != '\0'; ++text, ++start) {
        if (*text != *start) {
            return nullptr;
        }
    }
    return text;
}

/// The first entry that starts so, or nothing.
constexpr char** find_entry(char** environment, const char* start) {
    for (char** entry = environment; *entry != nullptr; ++entry) {
        if (after(*entry, start) != nullptr) {
            return entry;
        }
    }
    return nullptr;
}

bool is_to_be_changed(int count, char** arguments, char** environment) {
    for (const char* set : {"OMP_WAIT_POLICY=", "GOMP_SPINCOUNT="}) {
        if (find_entry(environment, set) != nullptr) {
            return false;
        }
    }
    for (const char* verb : {"run", "check"}) {
        const char* const rest = count > 1 ? after(arguments[1], verb) : nullptr;
        if (rest != nullptr && *rest == '\0') {
            return true;
        }
    }
    return false;
}

void set_for_libgomp(int count, char** arguments, char** environment) {
    is_wanted = is_to_be_changed(count, arguments, environment);
    if (!is_wanted) {
        return;
    }
    for (const char* idle : {"SHLVL=", "OLDPWD=", "PWD=", "LOGNAME=", "USER=", "HOME=", "PATH="}) {
        if (char** const entry = find_entry(environment, idle)) {
            changed_entry = entry;
            entry_before = std::exchange(*entry, setting);
            return;
        }
    }
}

[[gnu::section(".preinit_array"), gnu::used]] void (*before_libraries)(int, char**, char**) = set_for_libgomp;

} // namespace

void settle_waiting() {
    if (changed_entry != nullptr) {
        *changed_entry = entry_before;
    } else if (is_wanted && kmp_set_blocktime == nullptr) {
        note("an environment without PATH or HOME has no place for GOMP_SPINCOUNT: threads look out for each "
             "other for milliseconds, unless it sets that itself");
    }
}

} // namespace carom
