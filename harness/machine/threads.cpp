#include "harness/machine/threads.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <omp.h>

#include "harness/support/errors.hpp"
#include "kernels/parallel_for.hpp"

namespace carom {

int default_threads() {
    return std::clamp(std::min(omp_get_max_threads(), omp_get_thread_limit()), 1, most_threads);
}

int usable_processors() { return omp_get_num_procs(); }

void require_threads(int threads) {
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
