#pragma once

namespace carom {

inline constexpr int most_threads = 1024;

/// As many threads as OpenMP would use by itself, and no more than it grants.
int default_threads();

/// How many processors this process may use.
int usable_processors();

/// Throws InputError if OpenMP grants fewer threads: nothing may be reported of threads that never ran.
void require_threads(int threads);

} // namespace carom
