// A process that runs for as long as its one argument says, in loops.

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <string_view>
#include <system_error>

#include "harness/tests/calibration/loop.hpp"

int main(int count, char** words) {
    const std::string_view word = count == 2 ? words[1] : "";
    std::uint64_t loops = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), loops);
    if (word.empty() || error != std::errc() || end != word.data() + word.size()) {
        std::fputs("calibration_process: expected one argument, a number of loops\n", stderr);
        return 1;
    }
    std::printf("%llu\n", static_cast<unsigned long long>(carom::loop(loops)));
    return 0;
}
