#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace carom {

/// A text as std::printf would print it.
template <class... Values> std::string format(const char* pattern, Values... values) {
    std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, pattern, values...)), ' ');
    std::snprintf(text.data(), text.size() + 1, pattern, values...);
    return text;
}

} // namespace carom
