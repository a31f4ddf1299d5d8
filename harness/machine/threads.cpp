#include "harness/machine/threads.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <omp.h>
#include <pthread.h>
#include <unistd.h>

#include "harness/machine/machine.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/free_memory.hpp"
#include "harness/support/own_cgroup.hpp"
#include "harness/support/text.hpp"
#include "kernels/parallel_for.hpp"

/// LLVM's runtime, where the program is linked with it; in milliseconds.
extern "C" [[gnu::weak]] void kmp_set_blocktime(int milliseconds); // NOLINT(readability-*)

namespace carom {
namespace {

/// Threads of other programs that run or are ready to, and stay for a millisecond.
int others_running() {
    constexpr int looks = 4;
    int fewest = most_threads;
    for (int look = 0; look < looks && fewest > 0; ++look) {
        if (look > 0) {
            std::this_thread::sleep_for(std::chrono::microseconds(300));
        }
        fewest = std::min(fewest, parse_running(first_line("/proc/loadavg").value_or("")).value_or(1) - 1);
    }
    return std::max(fewest, 0);
}

/// Else the runtime ends the process, in words of its own. Stacks of another size than the system's
/// (OMP_STACKSIZE, KMP_STACKSIZE) are their user's.
void require_room_for_stacks(int threads) {
    const auto room = free_address_space();
    pthread_attr_t attributes;
    std::size_t stack = 0;
    if (!room || std::getenv("OMP_STACKSIZE") != nullptr || std::getenv("KMP_STACKSIZE") != nullptr ||
        pthread_getattr_default_np(&attributes) != 0 || pthread_attr_getstacksize(&attributes, &stack) != 0) {
        return;
    }
    if (*room / static_cast<std::int64_t>(stack) < threads - 1) {
        throw InputError("--threads: found " + std::to_string(threads) + ", whose stacks of " +
                         std::to_string(stack >> 20) + " MiB do not fit in " + std::to_string(*room >> 20) +
                         " MiB of address space; expected fewer, a smaller OMP_STACKSIZE, or more memory "
                         "(ulimit -v)");
    }
}

} // namespace

std::optional<double> read_cpu_quota(const std::filesystem::path& root) {
    std::optional<double> least;
    for (const std::filesystem::path& group : own_cgroups(root)) {
        const std::string line = first_line(group / "cpu.max").value_or("");
        const std::size_t blank = std::min(line.find(' '), line.size());
        const auto quota = parse_number<std::int64_t>(line.substr(0, blank));
        const auto period = parse_number<std::int64_t>(line.substr(std::min(blank + 1, line.size())));
        if (quota && period && *quota > 0 && *period > 0) {
            const double processors = static_cast<double>(*quota) / static_cast<double>(*period);
            least = std::min(processors, least.value_or(processors));
        }
    }
    return least;
}

int default_threads() {
    const int wanted =
        std::getenv("OMP_NUM_THREADS") != nullptr ? omp_get_max_threads() : usable_processors();
    return std::clamp(std::min(wanted, omp_get_thread_limit()), 1, most_threads);
}

int usable_processors() {
    // Asked for by every verb, and no process is moved to another control group while it computes.
    static const std::optional<double> quota = read_cpu_quota();
    const double most = std::floor(quota.value_or(most_threads));
    return static_cast<int>(std::clamp<double>(omp_get_num_procs(), 1, std::max(most, 1.0)));
}

int free_processors() {
    const auto online = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
    return std::clamp(online - others_running(), 1, usable_processors());
}

std::optional<int> parse_running(const std::string& line) {
    int running = 0;
    char behind = '\0';
    const int read = std::sscanf(line.c_str(), "%*s %*s %*s %d%c", &running, &behind);
    return read == 2 && behind == '/' ? std::optional(running) : std::nullopt;
}

void wait_asleep() {
    const auto is_set = [](const char* name) { return std::getenv(name) != nullptr; };
    if (kmp_set_blocktime != nullptr && !is_set("OMP_WAIT_POLICY") && !is_set("KMP_BLOCKTIME") &&
        !is_set("KMP_LIBRARY")) {
        kmp_set_blocktime(0);
    }
}

void end_where_threads_run_out_of_memory() {
    std::set_new_handler([] {
        if (omp_in_parallel() != 0) {
            static std::atomic_flag told; // by the first thread; the others wait for its end
            while (told.test_and_set()) {
                pause();
            }
            constexpr std::string_view line =
                "carom: out of memory: expected a machine with room for the scene, "
                "its boxes and what overlaps\n";
            [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
            _exit(1);
        }
        throw std::bad_alloc();
    });
}

void require_threads(int threads) {
    require_room_for_stacks(threads);
    // The limit is asked for first: LLVM's runtime prints a warning of its own where it refuses a thread.
    auto granted = static_cast<std::ptrdiff_t>(omp_get_thread_limit());
    if (granted >= threads) {
        std::vector<char> present(static_cast<std::size_t>(threads), 0);
        on_each_thread(threads, [&present](int thread) { present[static_cast<std::size_t>(thread)] = 1; });
        granted = std::ranges::count(present, 1);
    }
    if (granted < threads) {
        throw InputError("--threads: found " + std::to_string(threads) + ", but OpenMP grants " +
                         std::to_string(granted) + "; expected OMP_THREAD_LIMIT and OMP_DYNAMIC to allow it");
    }
}

} // namespace carom
