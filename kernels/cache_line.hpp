#pragma once

namespace carom {

/// How much memory, in bytes, moves between processors at a time: what different threads write lies as far
/// apart. True of x86-64 and most of Arm; where lines are longer, threads are slower and results the same.
/// (std::hardware_destructive_interference_size varies with -mtune, and clang 14 lacks it.)
inline constexpr int cache_line = 64;

} // namespace carom
