#pragma once

#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <string>

namespace carom {

/// A text as std::printf would print it. The compiler checks the values against the pattern.
[[gnu::format(printf, 1, 2)]] inline std::string format(const char* pattern, ...) {
    std::va_list values;
    va_start(values, pattern);
    std::va_list again;
    va_copy(again, values);
    std::string text(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, pattern, values)), ' ');
    std::vsnprintf(text.data(), text.size() + 1, pattern, again);
    va_end(again);
    va_end(values);
    return text;
}

} // namespace carom
